/// Tools as use volumes, read from YAML.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dismantle/export.h"
#include "dismantle/fasteners/kinds.h"

namespace dismantle::tools {

/// Outline of a volume across the axis.
enum class Form { tube, box, obround };

/// A part of a tool, or of the hand that holds it: an upright prism. Millimetres, in the frame of the tool in use: z is
/// the axis of the fastener, from its tip to its head; the handle points along x. z = 0 is the top of the fastener for
/// a tool that goes into a recess, else the lower side of the tool.
struct Volume {
  Form form = Form::tube;
  double low = 0, high = 0;                        ///< along z
  double inner = 0;                                ///< tube: radius of its hole
  double radius = 0;                               ///< tube, obround
  Eigen::Vector2d from = Eigen::Vector2d::Zero();  ///< box: smallest corner; obround: middle of one end
  Eigen::Vector2d to = Eigen::Vector2d::Zero();    ///< box: largest corner; obround: middle of the other end
};

/// One way to use a tool.
struct Use {
  std::string name;          ///< "short arm in the screw"; empty: there is one way only
  double swing = 0;          ///< rad between two grips; 0: the volumes do not turn
  double depth = 0;          ///< mm of the fastener that the tool takes hold of
  bool from_side = false;    ///< it is put on from the side, not along the axis
  bool beside = false;       ///< x = 0 is the circumference of the fastener, not its axis
  std::vector<Volume> tool;  ///< not empty
  std::vector<Volume> hand;  ///< of the hand that holds it
};

/// What a tool fits: a drive or a kind of part, and its size in mm (Torx: the number).
struct Fit {
  std::optional<fasteners::Drive> drive{};
  std::optional<fasteners::Kind> kind{};
  double least = 0, most = 0;
};

/// A tool that one takes into the hand.
struct Tool {
  std::string id;    ///< unique in its catalogue
  std::string name;  ///< for people
  std::vector<Fit> fits;
  std::vector<Use> uses;
};

/// @throws ConfigError with all problems of the text.
DISMANTLE_API std::vector<Tool> read_catalogue(const std::string& yaml, const std::string& file);
/// @throws ConfigError with all problems of the file, InputError for one that cannot be read.
DISMANTLE_API std::vector<Tool> read_catalogue(const std::filesystem::path& file);
/// The tools of catalogue/tools.yaml.
DISMANTLE_API const std::vector<Tool>& standard_catalogue();

}  // namespace dismantle::tools

// An importer that reads nothing without its parameter: a command that reads the input of a plan with default
// parameters fails. A file has a line NAME x y z X Y Z for each box.
#include <fstream>

#include "dismantle/errors.h"
#include "dismantle/plugin.h"

namespace {

struct BoxesParameters {
  double scale = 0;
  static void describe(dismantle::Schema<BoxesParameters>& s) {
    s.add("scale", &BoxesParameters::scale, {.unit = "1", .min = 0, .doc = "Factor on all lengths; 0 = not known."});
  }
};

class Boxes final : public dismantle::Importer {
 public:
  explicit Boxes(const BoxesParameters& params) : params_(params) {}
  std::vector<std::string> extensions() const override { return {"boxes"}; }

  std::vector<dismantle::RawPart> read(const std::filesystem::path& file, const dismantle::RunContext&) override {
    if (params_.scale <= 0) throw dismantle::InputError(file.string(), "cannot be read without its scale");
    std::ifstream in(file);
    std::vector<dismantle::RawPart> parts;
    std::string name;
    Eigen::Vector3d lo, hi;
    while (in >> name >> lo.x() >> lo.y() >> lo.z() >> hi.x() >> hi.y() >> hi.z()) {
      dismantle::RawPart& part = parts.emplace_back();
      part.name = name;
      for (int i = 0; i < 8; ++i)
        part.mesh.vertices.push_back(
            params_.scale * Eigen::Vector3d(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z()));
      part.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                             {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    }
    return parts;
  }

 private:
  BoxesParameters params_;
};

}  // namespace

DISMANTLE_PLUGIN("test.boxes", "1.0.0", "MIT", "https://example.org") {
  r.add<dismantle::Importer, Boxes, BoxesParameters>("test.boxes", "Boxes with a scale.", {.source = "none"});
}

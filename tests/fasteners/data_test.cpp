// Kinds by shape alone, names hidden, against $DISMANTLE_DATA/fasteners/truth.json.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "dismantle/fasteners/recognise.h"
#include "dismantle/geometry/length_unit.h"
#include "dismantle/session/session.h"
#include "dismantle/testing/data_folder.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

const char* const kFiles[] = {"fasteners/cbeam_linear_actuator_250mm.step",
                              "fasteners/nema_17_v_slot_belt_driven_actuator_500mm.step", "fasteners/smooth_idler.step",
                              "step/seedmint.step", "step/or_gripper.step"};

/// The entry of a product: its name, or the longest name that a body's name begins or ends with.
const json* entry_of(const json& truth, const std::string& part) {
  const json* best = nullptr;
  std::size_t length = 0;
  for (const auto& [name, entry] : truth.items()) {
    std::string trimmed = name;
    while (!trimmed.empty() && trimmed.back() == ' ') trimmed.pop_back();
    const std::string::size_type at = part.find(trimmed);
    const bool matches = at == 0 || (at != std::string::npos && at + trimmed.size() == part.size());
    if (entry.is_object() && matches && trimmed.size() > length) best = &entry, length = trimmed.size();
  }
  return best;
}

std::string without_number(const std::string& name) { return name.substr(0, name.rfind('#')); }

struct Found {
  std::string file, name;
  PartKind kind;
  double length;
};

/// The parts of one file, written in `unit`, recognised by shape.
std::vector<Found> found_in(const InputParts& input, const std::string& file, const std::string& unit,
                            const RunContext& context) {
  Assembly assembly;
  assembly.unit = unit;
  for (const RawPart& raw : input.parts) {
    if (!raw.problem.empty()) continue;
    const double scale = metres_in(raw.unit) / metres_in(unit);
    Mesh mesh = raw.mesh;
    for (Eigen::Vector3d& p : mesh.vertices) p *= scale;
    Part part;
    part.id = static_cast<PartId>(assembly.parts.size());
    part.name = raw.name;
    part.mesh = std::make_shared<const Mesh>(std::move(mesh));
    assembly.parts.push_back(std::move(part));
  }
  const auto shapes = fasteners::shapes_of(assembly, context);
  fasteners::recognise_kinds(assembly, context, {.names = false});
  std::vector<Found> out;
  for (const Part& part : assembly.parts)
    out.push_back({file, without_number(part.name), *part.kind, shapes[part.id].length});
  return out;
}

bool accepts(const json* entry, const std::string& kind) {
  if (entry == nullptr) return false;
  if (entry->at("kind") == kind) return true;
  if (!entry->contains("unclear")) return false;
  const json& also = entry->at("unclear");
  return std::find(also.begin(), also.end(), kind) != also.end();
}

struct Score {
  std::size_t right = 0, missed = 0, wrong = 0;
  double precision() const { return double(right) / double(std::max<std::size_t>(1, right + wrong)); }
  double recall() const { return double(right) / double(std::max<std::size_t>(1, right + missed)); }
};

Score score_of(const std::vector<Found>& found, const json& truth, const std::string& kind) {
  Score score;
  for (const Found& f : found) {
    const json* entry = entry_of(truth, f.name);
    // Bodies of products without an entry cannot be counted; whether a spacer is a washer is unclear for some.
    if (entry == nullptr) continue;
    const bool is = entry->at("kind") == kind;
    if (f.kind.kind == kind)
      (accepts(entry, kind) ? score.right : score.wrong) += 1;
    else if (is && !accepts(entry, f.kind.kind))
      ++score.missed;
  }
  return score;
}

TEST(FastenersOfRealFiles, AreRecognisedByShapeAloneInAnyUnit) {
  const fs::path data = test_data_folder(SOURCE_FOLDER);
  if (!fs::is_directory(data / "fasteners"))
    GTEST_SKIP() << (data / "fasteners").string() << " is not there; DISMANTLE_DATA names the folder of assemblies";
  std::ifstream stream(data / "fasteners" / "truth.json");
  const json truth = json::parse(stream);
  const Session session;
  const RunContext context = session.context();
  std::vector<InputParts> inputs;
  for (const char* file : kFiles) inputs.push_back(session.read(data / file, context));
  for (const std::string unit : {"mm", "m", "inch"}) {
    std::vector<Found> instances, shapes;
    std::set<std::pair<std::string, std::string>> seen;
    std::map<std::pair<std::string, std::string>, std::size_t> table;
    for (std::size_t i = 0; i < inputs.size(); ++i)
      for (Found& f : found_in(inputs[i], kFiles[i], unit, context)) {
        const json* entry = entry_of(truth, f.name);
        ++table[{entry == nullptr ? "(not stated)" : entry->at("kind").get<std::string>(), f.kind.kind}];
        if (seen.insert({f.file, f.name}).second) shapes.push_back(f);
        instances.push_back(std::move(f));
      }
    if (unit == "mm") {
      fmt::print("stated kind      recognised  instances\n");
      for (const auto& [row, count] : table) fmt::print("{:<16} {:<11} {}\n", row.first, row.second, count);
    }
    for (const std::string kind : {"screw", "nut", "washer"})
      for (const auto& [what, counted] : {std::pair{"instances", &instances}, std::pair{"shapes", &shapes}}) {
        const Score score = score_of(*counted, truth, kind);
        fmt::print("{:<4} {:<6} {:<9} right {} missed {} wrong {}: precision {:.3f}, recall {:.3f}\n", unit, kind, what,
                   score.right, score.missed, score.wrong, score.precision(), score.recall());
        EXPECT_GE(score.precision(), 0.95) << kind << ", " << what << ", " << unit;
        EXPECT_GE(score.recall(), 0.95) << kind << ", " << what << ", " << unit;
      }
    // Threads and lengths of screws and nuts.
    std::size_t sized = 0, right = 0;
    for (const Found& f : shapes) {
      const json* entry = entry_of(truth, f.name);
      if (entry == nullptr || !entry->contains("size") || entry->at("kind") != f.kind.kind) continue;
      if (f.kind.kind != "screw" && f.kind.kind != "nut") continue;
      std::string expected = entry->at("size");
      if (f.kind.kind == "screw" && entry->contains("length"))
        expected = fasteners::size_text(fasteners::Kind::screw, expected, entry->at("length"));
      ++sized;
      right += expected == f.kind.size;
      if (expected != f.kind.size) fmt::print("{}: '{}' is {}, stated {}\n", unit, f.name, f.kind.size, expected);
    }
    fmt::print("{:<4} sizes and lengths: {} of {} right\n", unit, right, sized);
    EXPECT_GE(double(right), 0.95 * double(sized)) << unit;
  }
}

}  // namespace
}  // namespace dismantle

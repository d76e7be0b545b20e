// From arbitrary triangles to an assembly, and what is wrong with it: what follows every importer.
#include "dismantle/preparation/prepare.h"

#include <cmath>

#include "dismantle/errors.h"
#include "dismantle/preparation/check_assembly.h"
#include "expect.h"
#include "input_file.h"

namespace dismantle::fuzz {
namespace {

constexpr double kSeconds = 3;
constexpr std::size_t kMostParts = 4;

/// Takes bytes as small whole numbers, so that corners coincide, lie on lines and in planes, as in real damage.
class Reader {
 public:
  explicit Reader(Bytes bytes) : rest_(bytes) {}
  bool done() const { return rest_.empty(); }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t b = rest_[0];
    rest_ = rest_.subspan(1);
    return b;
  }

 private:
  Bytes rest_;
};

RawPart read_part(Reader& in, std::size_t number) {
  RawPart part;
  part.name = part.file = "p" + std::to_string(number);
  const std::size_t vertices = in.byte() % 32, triangles = in.byte() % 64;
  const double unit = std::pow(10.0, in.byte() % 19 - 9.0);  // of coordinates: 1e-9 to 1e9
  for (std::size_t i = 0; i < vertices; ++i) {
    Eigen::Vector3d v;
    for (int k = 0; k < 3; ++k) v[k] = unit * static_cast<std::int8_t>(in.byte());
    part.mesh.vertices.push_back(v);
  }
  for (std::size_t i = 0; i < triangles && vertices > 0; ++i) {
    Triangle t;
    for (auto& corner : t) corner = static_cast<std::uint32_t>(in.byte() % vertices);
    part.mesh.triangles.push_back(t);
  }
  return part;
}

}  // namespace
}  // namespace dismantle::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  fuzz::Reader in({data, size});
  PrepareOptions options;
  const std::uint8_t choices = in.byte();
  options.repair = choices & 1;
  options.drop_duplicates = choices & 2;
  options.largest_connected = choices & 4;
  options.max_overlap = choices & 8 ? 0.1 : 1;
  options.min_thickness = choices & 16 ? 0.01 : 0;
  std::vector<RawPart> parts;
  while (!in.done() && parts.size() < fuzz::kMostParts) parts.push_back(fuzz::read_part(in, parts.size()));
  RunContext context;
  context.deadline = Deadline::after_seconds(fuzz::kSeconds);
  PrepareReport report;
  try {
    const Assembly assembly = prepare_assembly(std::move(parts), "fuzz", "", options, context, report);
    for (const auto& part : assembly.parts) {
      FUZZ_EXPECT(std::isfinite(part.volume));
      for (const auto& v : part.mesh->vertices) FUZZ_EXPECT(v.allFinite());
    }
    for (const auto& overlap : assembly.overlaps) FUZZ_EXPECT(std::isfinite(overlap.depth) && overlap.depth >= 0);
    const AssemblyCheck check = check_assembly(assembly, report, 1e-3, context);
    findings_text(check, "fuzz");
    findings_json(check);
  } catch (const Error&) {
  }
  return 0;
}

#include <fmt/format.h>
#include <unistd.h>

#include <set>

#include "dismantle/errors.h"
#include "dismantle/samples/samples.h"
#include "trial/files.h"

namespace dismantle::bench {
namespace {

namespace fs = std::filesystem;

fs::path offsets_file(const fs::path& folder) { return folder / "translation.json"; }

/// Uniform over all rotations.
Eigen::Quaterniond random_rotation(std::int64_t seed) {
  Rng rng = Rng(static_cast<std::uint64_t>(seed)).fork(0x726f74617465);  // "rotate": a separate random stream
  Eigen::Vector4d q;
  do {
    for (int i = 0; i < 4; ++i) q[i] = rng.normal();
  } while (q.norm() < 1e-3);
  q.normalize();
  return {q[0], q[1], q[2], q[3]};
}

void move_by_offsets(std::vector<RawPart>& parts, const fs::path& folder) {
  const fs::path file = offsets_file(folder);
  const nlohmann::json json = read_json(file);
  for (auto& part : parts) {
    if (!part.problem.empty()) continue;  // it has no place
    const std::string key = fs::path(part.file).stem().string();
    if (!json.is_object() || !json.contains(key))
      throw InputError(file.string(), fmt::format("has no offset for '{}' ({})", key, part.file));
    const auto& value = json.at(key);
    bool good = value.is_array() && value.size() == 3;
    for (std::size_t i = 0; good && i < 3; ++i) good = value[i].is_number();
    if (!good) throw InputError(file.string(), fmt::format("the offset of '{}' is not a list of three numbers", key));
    const Eigen::Vector3d offset(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
    for (auto& v : part.mesh.vertices) v += offset;
  }
}

/// Gives each part a unique and valid file name NAME.obj.
void name_files(std::vector<RawPart>& parts) {
  std::set<std::string> used;
  for (auto& part : parts) {
    std::string stem;
    for (const char c : part.name) stem += c == '/' || c == '\0' ? '_' : c;
    if (stem.empty() || stem[0] == '.') stem = "_" + stem;
    std::string name = stem;
    for (int n = 2; !used.insert(name).second; ++n) name = fmt::format("{}_{}", stem, n);
    part.file = name + ".obj";
  }
}

/// Writes a folder atomically: it exists completely or not at all.
void write_folder(const std::vector<RawPart>& parts, const fs::path& folder) {
  const fs::path scratch = folder.parent_path() / fmt::format(".{}.{}", folder.filename().string(), ::getpid());
  fs::remove_all(scratch);
  samples::write(parts, scratch);
  std::error_code error;
  fs::rename(scratch, folder, error);
  if (!error) return;
  fs::remove_all(scratch);
  if (!fs::is_directory(folder)) throw fs::filesystem_error("cannot make the assembly", folder, error);
}

}  // namespace

bool has_offsets(const fs::path& input) {
  std::error_code error;
  return fs::is_regular_file(offsets_file(input), error);
}

fs::path input_of(const TrialRequest& request, const std::function<InputParts(const fs::path&)>& read) {
  const bool offsets = request.sample.empty() && has_offsets(request.input);
  if (request.sample.empty() && !offsets && !request.rotate) return request.input;
  const fs::path folder = request.inputs / request.input_name;
  if (fs::is_directory(folder)) return folder;
  std::vector<RawPart> parts;
  if (request.sample.empty()) {
    parts = read(request.input).parts;
    std::erase_if(parts, [](const RawPart& part) { return part.by_meaning; });  // no parts of the assembly
    name_files(parts);
  } else {
    parts = samples::make(request.sample, request.sample_values);
  }
  if (offsets) move_by_offsets(parts, request.input);
  if (request.rotate) {
    const Eigen::Matrix3d turn = random_rotation(request.seed).toRotationMatrix();
    for (auto& part : parts)
      for (auto& v : part.mesh.vertices) v = turn * v;
  }
  write_folder(parts, folder);
  return folder;
}

}  // namespace dismantle::bench

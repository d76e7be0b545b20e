#include "dismantle/preparation/write_prepared.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "dismantle/errors.h"
#include "dismantle/preparation/read_input.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A file stem that every file system takes: no separators, no leading dot, not too long.
std::string safe_stem(const std::string& name) {
  std::string stem = valid_utf8(name);
  for (char& c : stem)
    if (std::strchr("/\\:*?\"<>|", c)) c = '_';
  if (!stem.empty() && stem[0] == '.') stem[0] = '_';
  if (stem.size() > 200) stem = valid_utf8(stem.substr(0, 200));
  return stem.empty() ? "part" : stem;
}

void write_text(const fs::path& file, const fmt::memory_buffer& text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out) throw Error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

fmt::memory_buffer as_obj(const Part& part, const Normalization& normalization) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "o {}\n", valid_utf8(part.name));
  for (const auto& v : part.mesh->vertices) {
    const Eigen::Vector3d p = normalization.to_input(v);
    fmt::format_to(out, "v {:.17g} {:.17g} {:.17g}\n", p.x(), p.y(), p.z());
  }
  for (const auto& t : part.mesh->triangles) fmt::format_to(out, "f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

Json vector_json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

}  // namespace

std::vector<fs::path> write_prepared(const Assembly& assembly, const PrepareReport& report, const fs::path& dir) {
  std::error_code ec;
  fs::create_directories(dir, ec);
  if (ec) throw Error(fmt::format("{}: folder cannot be made: {}", dir.string(), ec.message()));
  std::vector<fs::path> written;
  std::map<std::string, std::string> file_of;  // by part name
  std::set<std::string> used;
  for (const auto& part : assembly.parts) {
    const std::string stem = safe_stem(part.name);
    std::string file = stem + ".obj";
    for (int n = 2; !used.insert(file).second; ++n) file = fmt::format("{}#{}.obj", stem, n);
    file_of[part.name] = file;
    write_text(dir / file, as_obj(part, assembly.normalization));
    written.push_back(dir / file);
  }

  Json json;
  json["format"] = "dismantle.prepare";
  json["version"] = 1;
  json["source"] = valid_utf8(assembly.source);
  json["sha256"] = assembly.sha256;
  json["scale"] = assembly.normalization.scale;
  json["center"] = vector_json(assembly.normalization.center);
  json["bbox"] = Json::array({vector_json(assembly.input_box.lo), vector_json(assembly.input_box.hi)});
  json["parts"] = Json::array();
  for (const auto& part : report.parts) {
    Json p;
    p["name"] = part.name;
    p["file"] = part.file;
    p["kept"] = part.kept;
    if (part.kept)
      p["written"] = file_of[part.name];
    else
      p["reason"] = part.reason;
    p["vertices"] = part.vertices;
    p["triangles"] = part.triangles;
    p["shells"] = part.shells;
    p["watertight"] = part.watertight;
    if (!part.open.empty()) p["open"] = part.open;
    p["volume"] = part.volume;
    p["actions"] = part.actions;
    json["parts"].push_back(std::move(p));
  }
  json["overlaps"] = Json::array();
  for (const auto& o : assembly.overlaps) {
    Json pair;
    pair["parts"] = Json::array({assembly.parts[o.a].name, assembly.parts[o.b].name});
    pair["depth"] = o.depth;
    pair["depth_input_units"] = o.depth / assembly.normalization.scale;
    if (o.place) {
      const Normalization& n = assembly.normalization;
      const Eigen::Vector3d at = n.to_input(o.place->at), lo = n.to_input(o.place->region.lo),
                            hi = n.to_input(o.place->region.hi);
      pair["class"] = std::string(to_string(o.place->contact));
      pair["at"] = {at.x(), at.y(), at.z()};
      pair["region"] = {{lo.x(), lo.y(), lo.z()}, {hi.x(), hi.y(), hi.z()}};
    }
    json["overlaps"].push_back(std::move(pair));
  }
  json["excluded"] = Json::array();
  for (const auto& e : assembly.excluded) json["excluded"].push_back({{"name", e.name}, {"reason", e.reason}});
  json["warnings"] = report.warnings;
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "{}\n", json.dump(2, ' ', false, Json::error_handler_t::replace));
  write_text(dir / "prepare.json", text);
  written.push_back(dir / "prepare.json");
  return written;
}

}  // namespace dismantle

// acme.facets: an importer of a text format. One file holds any number of parts:
//
//   facets 1            the format and its version; comments begin with #
//   unit mm             optional: the unit of all coordinates
//   part shaft          a part; its name ends with the line
//   v 0 0 12.5          a vertex of this part
//   f 0 1 2             a triangle of this part: vertices by number from 0, counter-clockwise seen from outside
#include <cctype>
#include <fstream>
#include <sstream>

#include "dismantle/errors.h"
#include "dismantle/plugin.h"

namespace {

class AcmeFacets final : public dismantle::Importer {
 public:
  std::vector<std::string> extensions() const override { return {"acme_facets"}; }

  std::vector<dismantle::RawPart> read(const std::filesystem::path& file,
                                       const dismantle::RunContext& context) override {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw dismantle::InputError(file.string(), "cannot be read");
    Reader reader{file.string()};
    for (std::string line; std::getline(stream, line);) {
      if (reader.number % 1024 == 0 && context.should_stop()) throw dismantle::Error("stopped while reading");
      reader.take(line);
    }
    if (stream.bad()) throw dismantle::InputError(file.string(), "cannot be read to its end");
    for (auto& part : reader.parts) part.file = file.filename().string();
    return reader.finish();
  }

 private:
  struct Reader {
    std::string file;
    std::size_t number = 0;  // of the line
    bool begun = false;
    std::string unit{};
    std::vector<dismantle::RawPart> parts{};

    [[noreturn]] void fail(const std::string& why) const {
      throw dismantle::InputError(file, "line " + std::to_string(number) + ": " + why);
    }

    void take(const std::string& line) {
      ++number;
      std::istringstream words(line.substr(0, line.find('#')));
      std::string key;
      if (!(words >> key)) return;
      if (!begun) {
        int version = 0;
        if (key != "facets" || !(words >> version)) fail("the file has to begin with 'facets 1'");
        if (version != 1) fail("version " + std::to_string(version) + " of the format is not known");
        begun = true;
      } else if (key == "unit") {
        if (!(words >> unit)) fail("'unit' needs a unit");
      } else if (key == "part") {
        parts.emplace_back();
        std::getline(words >> std::ws, parts.back().name);
        while (!parts.back().name.empty() && std::isspace(static_cast<unsigned char>(parts.back().name.back())))
          parts.back().name.pop_back();
      } else if (parts.empty()) {
        fail("'" + key + "' before the first part");
      } else if (key == "v") {
        Eigen::Vector3d v;
        if (!(words >> v.x() >> v.y() >> v.z()) || !v.allFinite()) fail("a vertex is three numbers");
        parts.back().mesh.vertices.push_back(v);
      } else if (key == "f") {
        dismantle::Triangle t{};
        for (auto& corner : t) {
          std::int64_t n = -1;
          if (!(words >> n) || n < 0 || n > 0xffffffffLL) fail("a triangle is three vertex numbers");
          corner = static_cast<std::uint32_t>(n);
        }
        parts.back().mesh.triangles.push_back(t);
      } else {
        fail("'" + key + "' is none of unit, part, v, f");
      }
    }

    std::vector<dismantle::RawPart> finish() {
      if (!begun) fail("the file is empty");
      if (parts.empty()) fail("the file has no parts");
      for (auto& part : parts) {
        part.unit = unit;
        for (const auto& t : part.mesh.triangles)
          for (const auto corner : t)
            if (corner >= part.mesh.vertices.size())
              throw dismantle::InputError(file, "part '" + part.name + "' has no vertex " + std::to_string(corner));
      }
      return std::move(parts);
    }
  };
};

}  // namespace

DISMANTLE_PLUGIN("acme.facets", "0.1.0", "MIT", "https://example.org") {
  r.add<dismantle::Importer, AcmeFacets>("acme.facets", "Parts as lists of vertices and triangles, in text.",
                                         {.source = "own"});
}

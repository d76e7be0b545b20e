// A plugin that fits, but registers something that is not acceptable. Which, its file name says.
#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>

#include "dismantle/plugin.h"

namespace {

const int anchor = 0;

std::string file_name() {
  Dl_info info{};
  if (dladdr(&anchor, &info) == 0) throw std::runtime_error("dladdr does not know this library");
  return std::filesystem::path(info.dli_fname).stem().string();
}

class Nothing : public dismantle::Importer {
 public:
  std::vector<std::string> extensions() const override { return {}; }
  std::vector<dismantle::RawPart> read(const std::filesystem::path&, const dismantle::RunContext&) override {
    return {};
  }
};

enum class Flavour { sweet, sour };

struct Parameters {
  double size = 1.0;
  Flavour flavour = Flavour::sour;

  static void describe(dismantle::Schema<Parameters>& s) {
    const std::string fault = file_name();
    if (fault == "empty_doc")
      s.add("size", &Parameters::size, {.unit = "1", .doc = ""});
    else if (fault == "no_unit")
      s.add("size", &Parameters::size, {.unit = "", .doc = "Size."});
    else if (fault == "default_outside")
      s.add("size", &Parameters::size, {.unit = "s", .min = 2, .max = 3, .doc = "Size."});
    else if (fault == "default_no_choice")
      s.add_choice<Flavour>("flavour", &Parameters::flavour, {{"sweet", Flavour::sweet, "Sugar."}}, "Taste.");
    else if (fault == "bad_name")
      s.add("Size", &Parameters::size, {.unit = "1", .doc = "Size."});
    else if (fault == "reserved_name")
      s.add("type", &Parameters::size, {.unit = "1", .doc = "Size."});
    else
      s.add("size", &Parameters::size, {.unit = "1", .doc = "Size."});
  }
};

void add(dismantle::Registrar& r, const std::string& id, const std::string& summary = "Reads nothing.") {
  r.add<dismantle::Importer, Nothing, Parameters>(id, summary);
}

}  // namespace

DISMANTLE_PLUGIN("acme.bad_types", "1.0.0", "MIT", "https://example.org") {
  const std::string fault = file_name();
  if (fault == "throws_int") throw 7;
  if (fault == "no_types") return;
  if (fault == "bare_id") return add(r, "bare");
  if (fault == "bad_id") return add(r, "acme.Bad Id");
  if (fault == "no_summary") return add(r, "acme.quiet", "");
  add(r, "acme.good");
  if (fault == "throws") throw std::runtime_error("no licence for today");
  if (fault == "twice") add(r, "acme.good");
}

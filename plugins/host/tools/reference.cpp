// dismantle_reference [--check] FOLDER: writes docs/reference from the built-in plugins, or reports differences.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include "dismantle/host/describe.h"
#include "dismantle/plan_io/read_file.h"

namespace fs = std::filesystem;

namespace {

/// File name -> content.
std::map<std::string, std::string> pages(const dismantle::Registry& registry) {
  std::map<std::string, std::string> all;
  std::string index =
      "# Reference\n\nGenerated from the plugins' own declarations: `cmake --build BUILD --target reference`.\n";
  for (const auto kind : dismantle::kPluginKinds) {
    const std::string name(dismantle::to_string(kind));
    const auto types = registry.types(kind);
    if (types.empty()) continue;
    index += "\n## " + name + "\n\n";
    for (const auto* type : types) {
      const std::string file = name + "_" + type->type.id + ".md";
      const std::string preset = type->preset_of.empty() ? "" : " (preset of `" + type->preset_of + "`)";
      index += "- [" + type->type.id + "](" + file + ")" + preset + ": " + type->type.summary + "\n";
      all[file] = dismantle::describe_markdown(*type, registry);
    }
  }
  index += "\n## configuration\n\n- [sections](sections.md): the sections that are not one plugin\n";
  index += "- [dismantle.schema.json](dismantle.schema.json): JSON Schema for editors\n";
  index += "- [advanced parameters](advanced.md) of plugins and sections\n";
  all["advanced.md"] = dismantle::describe_advanced_markdown(registry);
  all["sections.md"] = dismantle::describe_sections_markdown();
  all["README.md"] = index;
  all["dismantle.schema.json"] = dismantle::json_schema(registry);
  return all;
}

int check(const std::map<std::string, std::string>& wanted, const fs::path& folder) {
  int differences = 0;
  for (const auto& [name, text] : wanted) {
    if (fs::exists(folder / name) && dismantle::read_file(folder / name) == text) continue;
    ++differences;
    std::cerr << (folder / name).string() << " is out of date\n";
  }
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (wanted.contains(entry.path().filename().string())) continue;
    ++differences;
    std::cerr << entry.path().string() << " belongs to no plugin\n";
  }
  if (differences > 0) std::cerr << "build the target 'reference' and commit docs/reference\n";
  return differences == 0 ? 0 : 1;
}

int write(const std::map<std::string, std::string>& wanted, const fs::path& folder) {
  fs::create_directories(folder);
  for (const auto& entry : fs::directory_iterator(folder))
    if (!wanted.contains(entry.path().filename().string())) fs::remove(entry.path());
  for (const auto& [name, text] : wanted) {
    std::ofstream stream(folder / name, std::ios::binary);
    stream << text;
    if (!stream.flush()) {
      std::cerr << "cannot write " << (folder / name).string() << "\n";
      return 1;
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const bool only_check = argc == 3 && std::string(argv[1]) == "--check";
  if ((argc != 2 && !only_check) || std::string_view(argv[argc - 1]).starts_with('-')) {
    std::cerr << "usage: dismantle_reference [--check] FOLDER\n";
    return 2;
  }
  try {
    dismantle::Registry registry(dismantle::built_in_plugin_folder());
    registry.scan();
    registry.load_all();
    for (const auto& problem : registry.problems())
      std::cerr << problem.file.string() << ": " << problem.message << "\n";
    if (!registry.problems().empty()) return 1;
    return only_check ? check(pages(registry), argv[2]) : write(pages(registry), argv[1]);
  } catch (const std::exception& e) {
    std::cerr << e.what() << "\n";
    return 1;
  }
}

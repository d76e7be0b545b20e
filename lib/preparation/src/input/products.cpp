#include "dismantle/preparation/products.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "dismantle/errors.h"
#include "dismantle/preparation/read_input.h"
#include "input/folder.h"
#include "input/readers.h"

namespace dismantle {

Products products_in(const std::filesystem::path& folder, const std::vector<std::shared_ptr<Importer>>& importers) {
  const Readers readers = readers_of(importers);
  const FolderContents contents = contents_of(
      folder, [&](const std::string& extension) { return readers.contains(extension); }, readable(readers));
  std::map<std::string, int> uses;
  for (const auto& file : contents.meshes) ++uses[valid_utf8(file.stem().string())];
  for (const auto& sub : contents.folders) ++uses[valid_utf8(sub.filename().string())];
  Products out;
  for (const auto& sub : contents.folders) out.products.push_back({valid_utf8(sub.filename().string()), sub});
  for (const auto& file : contents.meshes) {
    const std::string stem = valid_utf8(file.stem().string());
    out.products.push_back({uses[stem] > 1 ? valid_utf8(file.filename().string()) : stem, file});
  }
  if (out.products.empty())
    throw InputError(folder.string(), fmt::format("no product in this folder: no file that can be read ({}), and no "
                                                  "sub-folder with one",
                                                  readable(readers)));
  std::ranges::sort(out.products, [](const Product& a, const Product& b) { return natural_less(a.name, b.name); });
  for (std::size_t i = 1; i < out.products.size(); ++i)  // a folder "lid.obj" beside two files of that stem
    if (out.products[i].name == out.products[i - 1].name)
      throw InputError(folder.string(), fmt::format("two products are called '{}'", out.products[i].name));
  for (const RawPart& part : contents.rest)
    if (std::ranges::none_of(contents.folders,
                             [&](const auto& sub) { return part.name == valid_utf8(sub.filename().string()) + "/"; }))
      out.left_aside.push_back(fmt::format("{}: {}", part.name, part.problem));
  return out;
}

}  // namespace dismantle

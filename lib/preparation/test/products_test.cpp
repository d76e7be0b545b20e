#include "dismantle/preparation/products.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "dismantle/errors.h"
#include "dismantle/preparation/read_input.h"
#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

namespace fs = std::filesystem;
using NameList = std::vector<std::string>;

/// Reads ".box" files: as many boxes as they have bytes.
class BytesImporter : public Importer {
 public:
  std::vector<std::string> extensions() const override { return {"box"}; }
  std::optional<std::uint64_t> count_triangles(const fs::path&) const override { return std::nullopt; }
  std::vector<RawPart> read(const fs::path& file, const RunContext&) override {
    return std::vector<RawPart>(fs::file_size(file), RawPart{"", "", shapes::box({0, 0, 0}, {1, 1, 1})});
  }
};

std::vector<std::shared_ptr<Importer>> byte_importers() { return {std::make_shared<BytesImporter>()}; }

NameList names(const Products& found) {
  NameList out;
  for (const Product& product : found.products) out.push_back(product.name);
  return out;
}

TEST(Products, AreTheFilesAndSubFoldersThatCanBeRead) {
  const shapes::TempFolder folder;
  for (const char* name : {"lamp", "pictures", "10", ".hidden"}) fs::create_directory(folder / name);
  for (const char* file : {"lamp/1.box", "10/a.box", ".hidden/a.box", "2.box", "gearbox.BOX", "case.prt"})
    folder.write(file, "xx");
  folder.write("pictures/1.png", "x");
  folder.write("readme.txt", "x");
  const Products found = products_in(folder.path(), byte_importers());
  EXPECT_EQ(names(found), (NameList{"2", "10", "gearbox", "lamp"}));
  EXPECT_EQ(found.products[1].input, folder / "10");
  EXPECT_EQ(found.products[2].input, folder / "gearbox.BOX");
  ASSERT_EQ(found.left_aside.size(), 1u);
  EXPECT_TRUE(found.left_aside[0].starts_with("case.prt: no importer reads '.prt'")) << found.left_aside[0];
}

TEST(Products, HaveNamesOfTheirOwn) {
  const shapes::TempFolder folder;
  fs::create_directory(folder / "lamp");
  folder.write("lamp/1.box", "x");
  folder.write("lamp.box", "x");
  EXPECT_EQ(names(products_in(folder.path(), byte_importers())), (NameList{"lamp", "lamp.box"}));
  fs::create_directory(folder / "lamp.box.d");
  fs::rename(folder / "lamp.box.d", folder / "lamp.BOX");
  folder.write("lamp.BOX/1.box", "x");
  EXPECT_EQ(names(products_in(folder.path(), byte_importers())), (NameList{"lamp", "lamp.BOX", "lamp.box"}));
}

TEST(Products, AFolderWithoutOneIsNoInput) {
  const shapes::TempFolder folder;
  EXPECT_THROW(products_in(folder.path(), byte_importers()), InputError);
  EXPECT_THROW(products_in(folder / "none", byte_importers()), InputError);
}

TEST(Products, AFolderOfThemThatIsReadAsOneAssemblyIsNamed) {
  const shapes::TempFolder folder;
  folder.write("a.box", "xx");
  folder.write("b.box", "xxx");
  folder.write("c.box", "x");
  const InputParts three = read_input(folder.path(), byte_importers());
  ASSERT_EQ(three.warnings.size(), 1u);
  EXPECT_NE(three.warnings[0].find("2 of the 3 files hold several bodies"), std::string::npos);
  EXPECT_NE(three.warnings[0].find("dismantle plan --each"), std::string::npos);
  folder.write("b.box", "x");
  EXPECT_TRUE(read_input(folder.path(), byte_importers()).warnings.empty()) << "one file with several is a part";
}

}  // namespace
}  // namespace dismantle

// Which bodies of a product tree form a unit: on trees with known answers, and on random ones.
#include "dismantle/preparation/components.h"
#include "dismantle/preparation/name_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "dismantle/testing/shapes.h"

namespace dismantle {
namespace {

using Level = ComponentChoice::Level;
using Units = std::set<std::vector<PartId>>;

/// Boxes in a row. `paths`: for each, the names of the uses that contain it, outermost first; the last is the product.
Assembly tree_of(const std::vector<std::vector<std::string>>& paths) {
  std::vector<Mesh> boxes;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double x = 2 * static_cast<double>(i);
    boxes.push_back(shapes::box({x, 0, 0}, {x + 1, 1, 1}));
  }
  Assembly assembly = shapes::assembly_of(boxes);
  for (std::size_t i = 0; i < paths.size(); ++i) {
    Part& part = assembly.parts[i];
    part.parents.assign(paths[i].begin(), paths[i].end() - 1);
    const std::string& last = paths[i].back();
    part.product = last.substr(0, last.find(':'));  // "servo:2" is the second use of "servo"
    std::string id;
    for (const std::string& name : paths[i]) part.instances.push_back(id += "/" + name);
  }
  return assembly;
}

Units kept(const Assembly& assembly, const ComponentChoice& choice = {}) {
  Units out;
  for (const Component& c : components_of(assembly, choice))
    if (c.kept) out.insert(c.parts);
  return out;
}

/// Three levels: a frame, two servos of two bodies, and a purchased gearbox with a shaft of two bodies and a case.
Assembly machine() {
  return tree_of({{"machine", "frame"},
                  {"machine", "servo:1"},
                  {"machine", "servo:1"},
                  {"machine", "servo:2"},
                  {"machine", "servo:2"},
                  {"machine", "gearbox", "shaft"},
                  {"machine", "gearbox", "shaft"},
                  {"machine", "gearbox", "case"}});
}

TEST(Components, AProductOfSeveralBodiesUsedAsALeafIsOneUnitForEachUse) {
  EXPECT_EQ(kept(machine()), (Units{{1, 2}, {3, 4}, {5, 6}}));
  const auto components = components_of(machine(), {});
  ASSERT_EQ(components.size(), 3u);
  EXPECT_EQ(components[0].product, components[1].product);
  EXPECT_NE(components[0].name, components[1].name);
}

TEST(Components, TheUserDecides) {
  const Assembly a = machine();
  EXPECT_EQ(kept(a, {.level = Level::solid}), Units{});
  EXPECT_EQ(kept(a, {.level = Level::depth, .depth = 1}), (Units{{1, 2}, {3, 4}, {5, 6, 7}}));
  EXPECT_EQ(kept(a, {.together = {"gear*"}}), (Units{{1, 2}, {3, 4}, {5, 6, 7}}));
  EXPECT_EQ(kept(a, {.level = Level::solid, .together = {"gearbox"}}), (Units{{5, 6, 7}}));
  EXPECT_EQ(kept(a, {.apart = {"servo"}}), (Units{{5, 6}}));
  EXPECT_EQ(kept(a, {.level = Level::depth, .depth = 1, .apart = {"gearbox"}}), (Units{{1, 2}, {3, 4}, {5, 6}}));
}

TEST(Components, ADesignOfSeveralBodiesIsNoComponent) {
  EXPECT_EQ(kept(tree_of({{"box"}, {"box"}, {"box"}})), Units{});                                // a file of one product
  EXPECT_EQ(kept(tree_of({{"all", "box"}, {"all", "box"}})), Units{});                           // and a wrapper
  EXPECT_EQ(kept(tree_of({{"all"}, {"all"}, {"all", "servo"}, {"all", "servo"}})), (Units{{2, 3}}));  // on the root
  EXPECT_EQ(kept(shapes::assembly_of({shapes::box({0, 0, 0}, {1, 1, 1}), shapes::box({2, 0, 0}, {3, 1, 1})})), Units{});
}

TEST(Components, TheReasonSaysWhenTheReadingIsDoubtful) {
  const auto doubtful = [](const Assembly& a) {
    return std::ranges::all_of(components_of(a, {}),
                               [](const Component& c) { return c.reason.find("doubtful") != std::string::npos; });
  };
  EXPECT_TRUE(doubtful(tree_of({{"all", "lid"}, {"all", "lid"}, {"all", "tray"}, {"all", "tray"}})));
  EXPECT_FALSE(doubtful(machine()));
}

TEST(Components, ANameIsItsOwnPattern) {
  EXPECT_TRUE(name_matches("plate [M3] *", "plate [M3] *"));
  EXPECT_TRUE(name_matches("SKF_6002-2Z", "SKF_6002*"));
  EXPECT_FALSE(name_matches("nut", "n?"));
}

TEST(Components, UnitsShareNoPartAndNamesAreUnique) {
  for (int seed = 0; seed < 200; ++seed) {
    Rng rng(static_cast<std::uint64_t>(seed));
    std::vector<std::vector<std::string>> paths;
    const std::size_t parts = 2 + rng.below(9);
    for (std::size_t i = 0; i < parts; ++i) {
      paths.push_back({"all"});
      for (auto deeper = rng.below(4); deeper > 0; --deeper) paths.back().push_back(std::string(1, "abc"[rng.below(3)]));
    }
    const Assembly assembly = tree_of(paths);
    ComponentChoice choice;
    if (rng.below(2) == 0) choice = {.level = Level::depth, .depth = 1 + static_cast<unsigned>(rng.below(3))};
    if (rng.below(2) == 0) choice.together = {"b"};
    if (rng.below(2) == 0) choice.apart = {"c"};
    std::set<PartId> in_units;
    std::set<std::string> names;
    for (const Part& part : assembly.parts) names.insert(part.name);
    for (const Component& c : components_of(assembly, choice)) {
      EXPECT_TRUE(names.insert(c.name).second) << seed;
      EXPECT_GE(c.parts.size(), 2u);
      EXPECT_FALSE(c.reason.empty());
      if (!c.kept) continue;
      for (const PartId p : c.parts) EXPECT_TRUE(in_units.insert(p).second) << seed;
    }
  }
}

}  // namespace
}  // namespace dismantle

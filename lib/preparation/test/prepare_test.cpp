#include "dismantle/preparation/prepare.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dismantle/geometry/mesh_measure.h"
#include "dismantle/preparation/write_prepared.h"
#include "dismantle/testing/mesh_damage.h"

namespace dismantle {
namespace {

using namespace shapes;

struct PreparedRun {
  Assembly assembly;
  PrepareReport report;
};

PreparedRun prepare(std::vector<RawPart> raw, const PrepareOptions& options = {}, unsigned threads = 1) {
  RunContext context;
  context.threads = threads;
  PreparedRun out;
  out.assembly = prepare_assembly(std::move(raw), "made up", "0", options, context, out.report);
  return out;
}

std::string error_of(std::vector<RawPart> raw, const PrepareOptions& options = {}) {
  return input_error([&] { prepare(std::move(raw), options); });
}

const Mesh kUnit = box({0, 0, 0}, {1, 1, 1});
Mesh box_at(double x, double y = 0, double z = 0) { return moved(kUnit, shift({x, y, z})); }

TEST(Prepare, SchemaIsSound) {
  const Schema<PrepareOptions> schema;
  EXPECT_TRUE(problems_of_schema(schema.specs()).empty()) << problems_of_schema(schema.specs()).front();
  EXPECT_EQ(schema.specs().size(), 14u);
}

TEST(Prepare, ScalesTheBoxOfAllPartsToTen) {
  Rng rng(31);
  for (int round = 0; round < 20; ++round) {
    std::vector<RawPart> raws;
    Aabb input;
    for (int k = 0; k < 3; ++k) {
      const Mesh m = moved(random_solid(rng), shift({8.0 * k, 0, 0}));
      input.extend(m.box());
      raws.push_back(raw("p" + std::to_string(k), split_vertices(m)));
    }
    const auto original = raws;
    const auto [a, report] = prepare(raws);
    ASSERT_EQ(a.parts.size(), 3u);
    Aabb scaled;
    for (const auto& part : a.parts) {
      scaled.extend(part.mesh->box());
      EXPECT_TRUE(edge_use(*part.mesh).closed());
      EXPECT_TRUE(edge_use(*part.surface).closed());
      EXPECT_LE(longest_edge(*part.surface), 0.5 * (1 + 1e-12));
      EXPECT_NEAR(signed_volume(*part.surface), part.volume, 1e-9 * part.volume);
      EXPECT_NEAR(part.volume / std::pow(a.normalization.scale, 3), report.parts[part.id].volume, 1e-9);
      for (const auto& v : part.mesh->vertices)
        EXPECT_TRUE(input.contains(a.normalization.to_input(v)) ||
                    input.squared_distance(a.normalization.to_input(v)) < 1e-20);
    }
    EXPECT_NEAR(scaled.size().maxCoeff(), 10, 1e-12);
    EXPECT_LT(scaled.center().norm(), 1e-12);
  }
}

TEST(Prepare, ReportsWhatItDid) {
  Mesh flipped = split_vertices(sphere({4, 0, 0}, 1, 2));
  flip(flipped, 5);
  const auto [a, report] = prepare({raw("a", box_at(0)), raw("b", flipped)});
  EXPECT_EQ(a.parts.size(), 2u);
  EXPECT_TRUE(any_contains(report.parts[1].actions, "welded 384 vertices to 66"));
  EXPECT_TRUE(any_contains(report.parts[1].actions, "turned 1 triangle that faced the wrong way"));
  EXPECT_TRUE(report.parts[1].watertight);
  EXPECT_EQ(report.parts[1].shells, 1u);
}

TEST(Prepare, PartsThatCannotBeUsedAreNamedWithTheReason) {
  Mesh open = kUnit;
  open.triangles.resize(10);
  Mesh flat = box({0, 0, 0}, {1, 1, 0});
  Mesh nan = kUnit;
  nan.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  Mesh astray = kUnit;
  astray.triangles[0][1] = 99;
  PrepareOptions options;
  options.open = OpenSurfaces::exclude;
  const auto [a, report] = prepare({raw("a", box_at(0)), raw("open", open), raw("flat", flat), raw("nan", nan),
                                    raw("astray", astray), raw("empty", {}), raw("b", box_at(2))},
                                   options);
  ASSERT_EQ(a.parts.size(), 2u);
  EXPECT_EQ(a.parts[1].name, "b");
  EXPECT_EQ(a.parts[1].id, 1u);
  ASSERT_EQ(a.excluded.size(), 5u);
  EXPECT_NE(a.excluded[0].reason.find("not watertight even after repair: 4 open edges, the first near"),
            std::string::npos);
  EXPECT_NE(a.excluded[1].reason.find("no volume"), std::string::npos);
  EXPECT_NE(a.excluded[2].reason.find("vertex 4 is not a finite number"), std::string::npos);
  EXPECT_NE(a.excluded[3].reason.find("triangle 1 names vertex 100 of 8"), std::string::npos);
  EXPECT_NE(a.excluded[4].reason.find("no triangles"), std::string::npos);
  for (const auto& e : a.excluded) EXPECT_TRUE(any_contains(report.warnings, "part '" + e.name + "' is left out"));
}

TEST(Prepare, DoubleSidedPartsAreUsed) {
  Mesh m = box_at(2);
  for (std::size_t t = 0; t < 12; ++t) {
    m.triangles.push_back(m.triangles[t]);
    flip(m, 12 + t);
  }
  const auto [a, report] = prepare({raw("a", box_at(0)), raw("both", split_vertices(m))});
  EXPECT_EQ(a.parts.size(), 2u);
  EXPECT_TRUE(any_contains(report.parts[1].actions, "every face came with both senses"));
  EXPECT_NEAR(report.parts[1].volume, 1, 1e-12);
}

TEST(Prepare, FewerThanTwoPartsIsAnErrorThatListsThem) {
  Mesh open = kUnit;
  open.triangles.resize(10);
  PrepareOptions options;
  options.open = OpenSurfaces::exclude;
  EXPECT_NE(error_of({raw("one", kUnit)}).find("1 of 1 part can be used; an assembly needs at least two"),
            std::string::npos);
  const auto text = error_of({raw("one", kUnit), raw("lid", open)}, options);
  EXPECT_NE(text.find("1 of 2 parts can be used"), std::string::npos);
  EXPECT_NE(text.find("\n  lid: not watertight"), std::string::npos);
  EXPECT_NE(error_of({}).find("there are no parts"), std::string::npos);
}

TEST(Prepare, RepairCanBeSwitchedOff) {
  Mesh holed = sphere(Vec3::Zero(), 1, 3);
  holed.triangles.pop_back();
  PrepareOptions options;
  options.open = OpenSurfaces::exclude;
  const auto [with, report] = prepare({raw("a", holed), raw("b", box_at(3)), raw("c", box_at(5))}, options);
  EXPECT_EQ(with.parts.size(), 3u);
  EXPECT_TRUE(any_contains(report.parts[0].actions, "closed a hole of 3 edges near"));
  options.repair = false;
  EXPECT_EQ(prepare({raw("a", holed), raw("b", box_at(3)), raw("c", box_at(5))}, options).assembly.parts.size(), 2u);
}

TEST(Prepare, DuplicatesAreDroppedAndNameTheirTwin) {
  const Mesh other = refine(kUnit, 1);  // other triangles, same shape
  const auto [a, report] =
      prepare({raw("first", box_at(0)), raw("moved", box_at(1.5)), raw("second", box_at(0)), raw("third", other)});
  ASSERT_EQ(a.excluded.size(), 2u);
  EXPECT_EQ(a.excluded[0].name, "second");
  EXPECT_NE(a.excluded[0].reason.find("as 'first'"), std::string::npos);
  EXPECT_EQ(a.excluded[1].name, "third");
  PrepareOptions options;
  options.drop_duplicates = false;
  EXPECT_EQ(prepare({raw("first", box_at(0)), raw("second", box_at(0))}, options).assembly.parts.size(), 2u);
}

TEST(Prepare, DeepOverlapsAreDroppedWhenAsked) {
  PrepareOptions options;
  options.max_overlap = 0.1;
  // "b" is covered by a fifth from each side; without it, the others are free.
  const auto [a, report] = prepare({raw("a", box_at(0)), raw("b", box_at(0.8)), raw("c", box_at(1.6))}, options);
  ASSERT_EQ(a.excluded.size(), 1u);
  EXPECT_EQ(a.excluded[0].name, "b");
  EXPECT_NE(a.excluded[0].reason.find("% of its volume is inside other parts"), std::string::npos);
  EXPECT_EQ(prepare({raw("a", box_at(0)), raw("b", box_at(0.95))}, options).assembly.parts.size(), 2u);
}

TEST(Prepare, ThinPartsAreDroppedWhenAsked) {
  Rng rng(32);
  PrepareOptions options;
  options.min_thickness = 0.01;
  const Mesh sheet = moved(box({0, 0, 0}, {1, 1, 0.02}), {Vec3(0.5, 0, 0), random_pose(rng, 0).q});
  const auto [a, report] = prepare({raw("a", box_at(0)), raw("b", box_at(3)), raw("sheet", sheet)}, options);
  ASSERT_EQ(a.excluded.size(), 1u);
  EXPECT_EQ(a.excluded[0].name, "sheet");
  options.min_thickness = 0.004;
  EXPECT_EQ(prepare({raw("a", box_at(0)), raw("b", box_at(3)), raw("sheet", sheet)}, options).assembly.parts.size(),
            3u);
}

TEST(Prepare, FloatingPartsAreWarnedAboutOrDropped) {
  std::vector<RawPart> parts = {raw("a", box_at(0)), raw("b", box_at(0.9)), raw("c", box_at(1.8)),
                                raw("far", box_at(9))};
  const auto [kept, report] = prepare(parts);
  EXPECT_EQ(kept.parts.size(), 4u);
  EXPECT_TRUE(any_contains(report.warnings, "'far' floats apart from the rest"));
  PrepareOptions options;
  options.largest_connected = true;
  const auto [dropped, report2] = prepare(parts, options);
  ASSERT_EQ(dropped.excluded.size(), 1u);
  EXPECT_EQ(dropped.excluded[0].name, "far");
  EXPECT_NEAR(dropped.normalization.scale, 10 / 2.8, 1e-12);
}

TEST(Prepare, OverlapsAreMeasuredPerPair) {
  const auto [a, report] = prepare({raw("a", box({0, 0, 0}, {4, 4, 4})), raw("b", box({3.9, 1, 1}, {8, 3, 3})),
                                    raw("c", box({8, 0, 0}, {10, 4, 4}))});
  ASSERT_EQ(a.overlaps.size(), 1u);
  EXPECT_EQ(a.overlaps[0].a, 0u);
  EXPECT_EQ(a.overlaps[0].b, 1u);
  EXPECT_NEAR(a.overlaps[0].depth, 0.1, 2e-3);
  EXPECT_EQ(a.initial_overlap(1, 2), 0);
}

TEST(Prepare, MicroscopicAndHugeScalesGiveTheSameAssembly) {
  Rng rng(33);
  const Mesh p = random_solid(rng), q = moved(random_solid(rng), shift({3, 0, 0}));
  const auto [reference, r0] = prepare({raw("p", p), raw("q", q)});
  for (const double factor : {1e-30, 1e-9, 1e6, 1e30}) {
    Mesh ps = p, qs = q;
    for (auto& v : ps.vertices) v *= factor;
    for (auto& v : qs.vertices) v *= factor;
    const auto [a, report] = prepare({raw("p", ps), raw("q", qs)});
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(a.parts[i].mesh->triangles, reference.parts[i].mesh->triangles) << factor;
      for (std::size_t v = 0; v < a.parts[i].mesh->vertices.size(); ++v)
        ASSERT_LT((a.parts[i].mesh->vertices[v] - reference.parts[i].mesh->vertices[v]).norm(), 1e-9);
    }
  }
  Mesh absurd = p;
  for (auto& v : absurd.vertices) v *= 1e-200;
  EXPECT_NE(error_of({raw("p", absurd), raw("q", q)}).find("beyond what can be computed with"), std::string::npos);
}

TEST(Prepare, PartsKilometresApartAreWarnedAbout) {
  // A millimetre part, a thousand kilometres away, and one so far that its shape drowns in rounding.
  const auto [a, report] = prepare({raw("here", box_at(0)), raw("there", box_at(1e9)), raw("next", box_at(1.5))});
  EXPECT_EQ(a.parts.size(), 3u);
  EXPECT_TRUE(any_contains(report.warnings, "smaller than 0.2 % of the assembly"));
  EXPECT_TRUE(any_contains(report.warnings, "digits of its shape are left"));
  EXPECT_TRUE(any_contains(report.warnings, "'there' floats"));
}

TEST(Prepare, NamesAreUniqueAndKeepTheirLetters) {
  const auto [a, report] = prepare({raw("Größe 日本", box_at(0)), raw("Größe 日本", box_at(2))});
  EXPECT_EQ(a.parts[0].name, "Größe 日本");
  EXPECT_EQ(a.parts[1].name, "Größe 日本#2");
}

TEST(Prepare, CrossingSurfacesAreKeptWithAWarning) {
  Mesh m = tube(0.5, 1, 0, 1, 12);
  m.vertices[0] = Vec3(-3, 0.2, 0.5);  // pulled through the tube
  const auto [a, report] = prepare({raw("a", m), raw("b", box_at(4))});
  EXPECT_EQ(a.parts.size(), 2u);
  EXPECT_TRUE(any_contains(report.warnings, "part 'a': the surface crosses itself at"));
}

TEST(Prepare, InsertsAndVoidsStay) {
  Mesh hollow = closed_box({0, 0, 0}, {4, 4, 4}, 1), insert = box({5, 0, 0}, {9, 4, 4});
  append(insert, box({6, 1, 1}, {8, 3, 5}));
  const auto [a, report] = prepare({raw("hollow", hollow), raw("insert", insert)});
  EXPECT_TRUE(any_contains(report.parts[0].actions, "1 void inside the solid is empty"));
  EXPECT_NEAR(report.parts[0].volume, 64 - 8, 1e-9);
  EXPECT_TRUE(any_contains(report.parts[1].actions, "shells of this part overlap"));
  EXPECT_EQ(report.parts[1].shells, 2u);
}

TEST(Prepare, TooManyTrianglesAreRefused) {
  PrepareOptions options;
  options.max_triangles = 20;
  EXPECT_NE(
      error_of({raw("a", box_at(0)), raw("b", box_at(2))}, options).find("24 triangles are more than the limit of 20"),
      std::string::npos);
  options.max_triangles = 1000;
  options.subdivide = 0.01;
  EXPECT_NE(error_of({raw("a", box_at(0)), raw("b", box_at(2))}, options).find("raise assembly.subdivide"),
            std::string::npos);
}

TEST(Prepare, TheNumberOfThreadsDoesNotMatter) {
  Rng rng(34);
  std::vector<RawPart> raws;
  for (int k = 0; k < 8; ++k)
    raws.push_back(raw("p" + std::to_string(k), moved(random_solid(rng), shift({1.5 * k, 0, 0}))));
  PrepareOptions options;
  options.max_overlap = 0.5;
  const auto [a, r1] = prepare(raws, options, 1);
  const auto [b, r2] = prepare(raws, options, 4);
  ASSERT_EQ(a.parts.size(), b.parts.size());
  for (std::size_t i = 0; i < a.parts.size(); ++i) {
    EXPECT_EQ(a.parts[i].surface->vertices, b.parts[i].surface->vertices);
    EXPECT_EQ(a.parts[i].surface->triangles, b.parts[i].surface->triangles);
  }
  ASSERT_EQ(a.overlaps.size(), b.overlaps.size());
  for (std::size_t i = 0; i < a.overlaps.size(); ++i) {
    EXPECT_EQ(a.overlaps[i].depth, b.overlaps[i].depth);
    ASSERT_TRUE(a.overlaps[i].place && b.overlaps[i].place);
    EXPECT_EQ(a.overlaps[i].place->contact, b.overlaps[i].place->contact);
    EXPECT_EQ(a.overlaps[i].place->at, b.overlaps[i].place->at);
    EXPECT_EQ(a.overlaps[i].place->region.lo, b.overlaps[i].place->region.lo);
    EXPECT_EQ(a.overlaps[i].place->region.hi, b.overlaps[i].place->region.hi);
    EXPECT_EQ(a.overlaps[i].place->share, b.overlaps[i].place->share);
  }
  EXPECT_EQ(r1.warnings, r2.warnings);
}

TEST(Prepare, StopsWhenAsked) {
  RunContext context;
  context.cancel.cancel();
  PrepareReport report;
  EXPECT_THROW(prepare_assembly({raw("a", box_at(0)), raw("b", box_at(2))}, "", "", {}, context, report), Error);
}

TEST(WritePrepared, WritesPartsAndReport) {
  const TempFolder folder;
  Mesh open = kUnit;
  open.triangles.resize(10);
  PrepareOptions options;
  options.open = OpenSurfaces::exclude;
  const auto [a, report] =
      prepare({raw("plate / left", box_at(0.1)), raw("Größe", box_at(1.05)), raw("open", open)}, options);
  const auto files = write_prepared(a, report, folder / "out");
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[0].filename(), "plate _ left.obj");
  EXPECT_EQ(files[1].filename(), "Größe.obj");
  std::ifstream in(files[2]);
  const auto json = nlohmann::json::parse(in);
  EXPECT_EQ(json["format"], "dismantle.prepare");
  EXPECT_EQ(json["parts"].size(), 3u);
  EXPECT_EQ(json["parts"][0]["written"], "plate _ left.obj");
  EXPECT_EQ(json["parts"][2]["kept"], false);
  EXPECT_EQ(json["excluded"][0]["name"], "open");
  ASSERT_EQ(json["overlaps"].size(), 1u);
  EXPECT_NEAR(json["overlaps"][0]["depth_input_units"].get<double>(), 0.05, 1e-3);
  std::ifstream obj(files[0]);
  std::string word;
  Aabb written;
  while (obj >> word)
    if (word == "v") {
      Vec3 v;
      obj >> v.x() >> v.y() >> v.z();
      written.extend(v);
    }
  EXPECT_LT((written.lo - Vec3(0.1, 0, 0)).norm(), 1e-14);
}

TEST(WritePrepared, NamesTheFolderThatCannotBeMade) {
  const TempFolder folder;
  const auto [a, report] = prepare({raw("a", box_at(0)), raw("b", box_at(2))});
  const auto file = folder.write("file", "x");
  try {
    write_prepared(a, report, file / "sub");
    ADD_FAILURE() << "wrote below a file";
  } catch (const InputError& e) {
    ADD_FAILURE() << "nothing is wrong with the input: " << e.what();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find((file / "sub").string()), std::string::npos);
  }
}

}  // namespace
}  // namespace dismantle

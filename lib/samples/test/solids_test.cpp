/// Laws of every sample, for its defaults and for random parameters.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "dismantle/parameters.h"
#include "sample_checks.h"

namespace dismantle::samples {
namespace {

constexpr int kDraws = 6;

double volume(const Mesh& mesh) {
  double six = 0;
  const Eigen::Vector3d o = mesh.box().center();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    six += (mesh.vertex(t, 0) - o).dot((mesh.vertex(t, 1) - o).cross(mesh.vertex(t, 2) - o));
  return six / 6;
}

void expect_closed_and_oriented(const RawPart& part) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  std::vector<char> used(part.mesh.vertices.size(), 0);
  for (const Triangle& t : part.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      ++edges[{t[k], t[(k + 1) % 3]}];
      used.at(t[k]) = 1;
    }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1) << part.name;
    ASSERT_TRUE(edges.contains({edge.second, edge.first})) << part.name;
  }
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0) << part.name << " has vertices that no triangle uses";
  EXPECT_GT(volume(part.mesh), 0) << part.name;
}

void expect_no_coincident_vertices(const RawPart& part) {
  std::set<std::array<double, 3>> seen;
  for (const auto& v : part.mesh.vertices)
    ASSERT_TRUE(seen.insert({v.x(), v.y(), v.z()}).second) << part.name << " has two vertices in one place";
}

/// Every vertex has one fan of triangles: no two sheets touch in a point or along an edge.
void expect_single_fans(const RawPart& part) {
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(part.mesh.vertices.size());
  for (const Triangle& t : part.mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) next[t[k]][t[(k + 1) % 3]] = t[(k + 2) % 3];
  for (const auto& fan : next) {
    if (fan.empty()) continue;
    std::size_t length = 0;
    std::uint32_t at = fan.begin()->first;
    do {
      at = fan.at(at);
      ++length;
    } while (at != fan.begin()->first && length <= fan.size());
    ASSERT_EQ(length, fan.size()) << part.name;
  }
}

void expect_laws(const Model& model, Rng& rng, bool crossings) {
  ASSERT_GE(model.parts.size(), 2u);
  std::set<std::string> names;
  for (const RawPart& part : model.parts) {
    EXPECT_TRUE(names.insert(part.name).second) << part.name;
    EXPECT_EQ(part.file, part.name + ".obj");
    expect_closed_and_oriented(part);
    expect_no_coincident_vertices(part);
    expect_single_fans(part);
  }
  const auto parts = probes(model, rng);
  for (const Probe& p : parts) {
    if (crossings) {
      EXPECT_EQ(self_crossing(*p.mesh, *p.bvh), "") << p.name;
    }
  }
  const std::size_t pairs = parts.size() * (parts.size() - 1) / 2;
  if (model.truth.contacts.size() < pairs) {
    EXPECT_GT(model.clearance, 0);
  }
  for (std::size_t a = 0; a < parts.size(); ++a)
    for (std::size_t b = a + 1; b < parts.size(); ++b) {
      if (contact_of(model, parts[a].name, parts[b].name)) continue;
      Aabb near = parts[a].box;
      near.inflate(model.clearance);
      if (!near.overlaps(parts[b].box)) continue;
      EXPECT_FALSE(closer_than(parts[a], {}, parts[b], {}, model.clearance * (1 - 1e-6) - 1e-9))
          << parts[a].name << " and " << parts[b].name;
    }
}

class EverySample : public ::testing::TestWithParam<std::string> {};

TEST_P(EverySample, DeclaresItsParametersProperly) {
  const Sample& sample = *find(GetParam());
  EXPECT_EQ(problems_of_schema(sample.params), std::vector<std::string>{});
  EXPECT_FALSE(sample.summary.empty());
}

TEST_P(EverySample, IsSolidAndKeepsItsClearance) {
  Rng rng(11);
  expect_laws(make_model(GetParam()), rng, true);
}

TEST_P(EverySample, IsSolidForRandomParameters) {
  Rng rng(12);
  for (int i = 0; i < kDraws; ++i) {
    ParamSet drawn;
    const Model model = random_model(*find(GetParam()), rng, drawn);
    SCOPED_TRACE(text(drawn));
    expect_laws(model, rng, i < 3);
    if (HasFatalFailure()) return;
  }
}

TEST_P(EverySample, SaysWhetherItIsClean) {
  const Model model = make_model(GetParam());
  EXPECT_EQ(find(GetParam())->clean, model.truth.contacts.empty());
  std::set<std::string> names;
  for (const RawPart& part : model.parts) names.insert(part.name);
  for (const TruthContact& c : model.truth.contacts)
    EXPECT_TRUE(names.contains(c.a) && names.contains(c.b) && c.a != c.b);
}

TEST_P(EverySample, IsTheSameEveryTime) {
  const auto a = make(GetParam(), {{"rotate_seed", std::int64_t{5}}}),
             b = make(GetParam(), {{"rotate_seed", std::int64_t{5}}});
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].mesh.vertices, b[i].mesh.vertices);
    EXPECT_EQ(a[i].mesh.triangles, b[i].mesh.triangles);
  }
}

TEST_P(EverySample, RotateSeedTurnsTheWholeAssembly) {
  const auto plain = make(GetParam()), turned = make(GetParam(), {{"rotate_seed", std::int64_t{9}}});
  ASSERT_EQ(plain.size(), turned.size());
  // The rotation follows from three vertices of the first part; all others must agree with it.
  const auto &p = plain[0].mesh.vertices, &t = turned[0].mesh.vertices;
  std::size_t third = 2;
  while ((p[1] - p[0]).cross(p[third] - p[0]).norm() < 1e-3) ++third;
  const auto frame = [third](const std::vector<Eigen::Vector3d>& v) {
    Eigen::Matrix3d m;
    m.col(0) = (v[1] - v[0]).normalized();
    m.col(1) = (v[1] - v[0]).cross(v[third] - v[0]).normalized();
    m.col(2) = m.col(0).cross(m.col(1));
    return m;
  };
  const Eigen::Matrix3d rotation = frame(t) * frame(p).transpose();
  EXPECT_NEAR(rotation.determinant(), 1, 1e-9);
  EXPECT_GT((rotation - Eigen::Matrix3d::Identity()).norm(), 0.1);
  for (std::size_t i = 0; i < plain.size(); ++i)
    for (std::size_t k = 0; k < plain[i].mesh.vertices.size(); ++k)
      ASSERT_LT((rotation * plain[i].mesh.vertices[k] - turned[i].mesh.vertices[k]).norm(), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, EverySample, ::testing::ValuesIn(sample_names()),
                         [](const auto& test) { return test.param; });

TEST(Samples, RefuseWhatTheyDoNotKnow) {
  EXPECT_EQ(find("no_such_sample"), nullptr);
  EXPECT_THROW(make("no_such_sample"), std::invalid_argument);
  EXPECT_THROW(make("l_slot", {{"lenght", 3.0}}), std::invalid_argument);
  EXPECT_THROW(make("l_slot", {{"length", -3.0}}), std::invalid_argument);
  EXPECT_THROW(make("l_slot", {{"length", std::string("long")}}), std::invalid_argument);
  EXPECT_THROW(make("bolt_and_nut", {{"diameter", 6.0}, {"pitch", 3.0}}), std::invalid_argument);
  EXPECT_THROW(make("threaded_legs", {{"diameter", 8.0}}), std::invalid_argument);  // its pitch is half of that
  EXPECT_THROW(make("machine", {{"parts", std::int64_t{1}}}), std::invalid_argument);
}

TEST(Samples, IsoThreadHasTheStandardDimensions) {
  // M10x1.5: major 10, minor 10 - 1.25 H = 8.376 mm (ISO 724).
  const auto parts = make("bolt_and_nut");
  double crest = 0;
  for (const auto& v : parts[0].mesh.vertices)
    if (v.z() > 3) crest = std::max(crest, std::hypot(v.x(), v.y()));
  EXPECT_NEAR(2 * crest, 10, 1e-9);
  double root = 1e9;
  for (const auto& v : parts[0].mesh.vertices)
    if (v.z() > 3 && std::hypot(v.x(), v.y()) > 4.15) root = std::min(root, std::hypot(v.x(), v.y()));
  EXPECT_NEAR(2 * root, 8.376, 1e-3);
}

TEST(Samples, ClosedBoxHasWallsAllAround) {
  for (const double wall : {0.003, 0.0005, 0.05}) {
    const Model model = make_model("closed_box", {{"wall", wall}});
    const Mesh &box = model.parts.at(0).mesh, &plate = model.parts.at(1).mesh;
    const TriangleBvh bvh(box);
    Rng rng(3);
    const Eigen::Vector3d centre = box.box().center(), half = 0.5 * box.box().size();
    const Eigen::Vector3d middle = half - Eigen::Vector3d::Constant(wall * 100 / 2);
    EXPECT_FALSE(bvh.inside(plate.box().center()));
    for (int i = 0; i < 2000; ++i) {
      Eigen::Vector3d p(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      p /= p.cwiseAbs().maxCoeff();
      EXPECT_TRUE(bvh.inside(centre + middle.cwiseProduct(p)));
    }
    EXPECT_TRUE(model.truth.steps.empty());
  }
}

TEST(Samples, MachineHasAsManyPartsAsAsked) {
  for (std::int64_t n = 4; n <= 80; ++n) EXPECT_EQ(make("machine", {{"parts", n}}).size(), static_cast<std::size_t>(n));
  const auto triangles = [](std::int64_t n) {
    std::size_t count = 0;
    for (const auto& part : make("machine", {{"parts", n}})) count += part.mesh.triangles.size();
    return static_cast<double>(count) / static_cast<double>(n);
  };
  EXPECT_EQ(make("machine", {{"parts", std::int64_t{400}}}).size(), 400u);
  EXPECT_LT(triangles(400), 2 * triangles(50));  // work grows with the number of parts, not faster
}

}  // namespace
}  // namespace dismantle::samples

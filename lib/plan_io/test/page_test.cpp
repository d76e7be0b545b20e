// index.html: the page holds the plan and the surfaces, for any names; congruent parts share one surface.
#include "dismantle/plan_io/page.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "dismantle/errors.h"
#include "dismantle/plan_io/plan_file.h"

namespace dismantle {
namespace {

using PageJson = nlohmann::json;
constexpr const char* kTemplate = "<html><script id=data>@DISMANTLE_DATA@</script></html>";

std::vector<std::uint8_t> bytes_of_base64(const std::string& text) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> out;
  EXPECT_EQ(text.size() % 4, 0u);
  for (std::size_t i = 0; i + 3 < text.size(); i += 4) {
    std::uint32_t word = 0;
    int count = 3;
    for (std::size_t k = 0; k < 4; ++k) {
      const char c = text[i + k];
      if (c == '=') --count;
      word = word << 6 | (c == '=' ? 0u : static_cast<std::uint32_t>(digits.find(c)));
    }
    for (int k = 0; k < count; ++k) out.push_back(static_cast<std::uint8_t>(word >> (16 - 8 * k)));
  }
  return out;
}

template <class Scalar>
std::vector<Scalar> array_of(const PageJson& text) {
  const auto bytes = bytes_of_base64(text.get<std::string>());
  std::vector<Scalar> out(bytes.size() / sizeof(Scalar));
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof(Scalar));
  return out;
}

std::vector<std::uint32_t> indices_of(const PageJson& shape, const char* key) {
  if (shape["wide"].get<bool>()) return array_of<std::uint32_t>(shape[key]);
  const auto narrow = array_of<std::uint16_t>(shape[key]);
  return {narrow.begin(), narrow.end()};
}

Mesh page_box(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.emplace_back(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z());
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

/// A prism over a circle, so fine that its side is shaded smoothly.
Mesh page_prism(std::uint32_t sides) {
  Mesh m;
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double a = 2 * std::numbers::pi * i / sides;
    m.vertices.emplace_back(std::cos(a), std::sin(a), 0);
    m.vertices.emplace_back(std::cos(a), std::sin(a), 2);
  }
  m.vertices.emplace_back(0, 0, 0);
  m.vertices.emplace_back(0, 0, 2);
  for (std::uint32_t i = 0; i < sides; ++i) {
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % sides);
    m.triangles.insert(m.triangles.end(),
                       {{a, b, b + 1}, {a, b + 1, a + 1}, {b, a, 2 * sides}, {a + 1, b + 1, 2 * sides + 1}});
  }
  return m;
}

struct Subject {
  Plan plan;
  Assembly assembly;

  void add(const std::string& name, Mesh mesh) {
    Part part;
    part.id = static_cast<PartId>(assembly.parts.size());
    part.name = name;
    part.mesh = part.surface = std::make_shared<Mesh>(std::move(mesh));
    for (const auto& v : part.mesh->vertices) assembly.input_box.extend(assembly.normalization.to_input(v));
    plan.assembly.parts.push_back({part.id, name, name + ".obj"});
    assembly.parts.push_back(std::move(part));
  }

  PageJson data() const {
    const std::string page = to_page(plan, assembly, kTemplate);
    const std::string before = "<html><script id=data>", after = "</script></html>";
    EXPECT_EQ(page.substr(0, before.size()), before);
    EXPECT_EQ(page.substr(page.size() - after.size()), after);
    const std::string inside = page.substr(before.size(), page.size() - before.size() - after.size());
    EXPECT_EQ(inside.find('<'), std::string::npos) << "what could end the script, or begin a comment in it";
    return PageJson::parse(inside);
  }
};

using Random = std::mt19937_64;
double between(Random& random, double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); }
Eigen::Vector3d random_vector(Random& random, double size) {
  return {between(random, -size, size), between(random, -size, size), between(random, -size, size)};
}
Pose random_pose(Random& random) {
  const Eigen::Vector3d axis = random_vector(random, 1);
  return {random_vector(random, 5), Eigen::Quaterniond(1.0, axis.x(), axis.y(), axis.z()).normalized()};
}
Mesh moved(Mesh mesh, const Pose& pose) {
  for (auto& v : mesh.vertices) v = pose * v;
  return mesh;
}
/// A closed surface without symmetry: no rotation takes it to its mirror image.
Mesh random_tetrahedron(Random& random) {
  Mesh m;
  m.vertices = {Eigen::Vector3d::Zero(),
                {between(random, 1, 2), 0, 0},
                {between(random, 0.1, 0.4), between(random, 2.5, 3.5), 0},
                {between(random, 0.1, 0.3), between(random, 0.2, 0.4), between(random, 4.5, 6)}};
  m.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return m;
}

TEST(Page, HoldsThePlanWordForWord) {
  Subject subject;
  subject.add("peg", page_box({0, 0, 0}, {1, 1, 1}));
  subject.plan.assembly.source = "a folder";
  subject.plan.remaining = {"peg"};
  EXPECT_EQ(subject.data()["plan"], PageJson::parse(to_json(subject.plan)));
}

TEST(Page, NamesStayAsTheyAreAndCannotLeaveTheScript) {
  for (const std::string name : {"</script><script>alert(1)</script>", "<!--<script>", "<img src=x onerror=alert(1)>",
                                 "a&lt;b", "\"\\u003c", "two  blanks", "ends with \\", "a\" \\\" b : , \\", "a\n b"}) {
    Subject subject;
    subject.add(name, page_box({0, 0, 0}, {1, 1, 1}));
    EXPECT_EQ(subject.data()["plan"]["assembly"]["parts"][0]["name"], name);
  }
}

TEST(Page, EveryTriangleStandsWhereItIsInTheInput) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    Subject subject;
    subject.assembly.normalization = {between(random, 0.01, 20), random_vector(random, 50)};
    const std::vector<Mesh> kinds = {random_tetrahedron(random), page_prism(24), page_box({0, 0, 0}, {1, 2, 3})};
    for (int i = 0; i < 6; ++i) subject.add("p" + std::to_string(i), moved(kinds[i % 3], random_pose(random)));
    const PageJson geometry = subject.data()["geometry"];
    ASSERT_EQ(geometry["parts"].size(), 6u);
    EXPECT_EQ(geometry["shapes"].size(), 3u) << "congruent parts share a surface";
    for (std::size_t i = 0; i < 6; ++i) {
      const PageJson& part = geometry["parts"][i];
      const PageJson& shape = geometry["shapes"][part["shape"].get<std::size_t>()];
      const auto p = part["place"].get<std::vector<double>>();
      const Pose place{{p[0], p[1], p[2]}, Eigen::Quaterniond(p[3], p[4], p[5], p[6])};
      const auto positions = array_of<float>(shape["positions"]);
      const auto normals = array_of<std::int16_t>(shape["normals"]);
      const auto triangles = indices_of(shape, "triangles");
      const Mesh& mesh = *subject.assembly.parts[i].mesh;
      const double size = subject.assembly.input_box.size().maxCoeff();
      ASSERT_EQ(triangles.size(), 3 * mesh.triangles.size());
      ASSERT_EQ(normals.size(), positions.size());
      for (std::size_t k = 0; k < triangles.size(); ++k) {
        const float* at = &positions[3 * triangles[k]];
        const Eigen::Vector3d seen = place * Eigen::Vector3d(at[0], at[1], at[2]);
        const Eigen::Vector3d told =
            subject.assembly.normalization.to_input(mesh.vertex(k / 3, static_cast<int>(k % 3)));
        EXPECT_LT((seen - told).norm(), 1e-5 * size);
      }
      Aabb box;
      for (const auto& v : mesh.vertices) box.extend(subject.assembly.normalization.to_input(v));
      for (Eigen::Index k = 0; k < 3; ++k) {
        EXPECT_NEAR(part["box"][0][k].get<double>(), box.lo[k], 1e-9 * size);
        EXPECT_NEAR(part["box"][1][k].get<double>(), box.hi[k], 1e-9 * size);
      }
    }
  }
}

TEST(Page, MirrorImagesAndLikenessesKeepSurfacesOfTheirOwn) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    Subject subject;
    const Mesh original = random_tetrahedron(random);
    Mesh mirrored = original, larger = original;
    for (auto& v : mirrored.vertices) v.x() = -v.x();
    for (auto& v : larger.vertices) v *= 1.01;
    subject.add("original", original);
    subject.add("mirrored", moved(mirrored, random_pose(random)));
    subject.add("larger", moved(larger, random_pose(random)));
    subject.add("same", moved(original, random_pose(random)));
    const PageJson parts = subject.data()["geometry"]["parts"];
    EXPECT_NE(parts[0]["shape"], parts[1]["shape"]);
    EXPECT_NE(parts[0]["shape"], parts[2]["shape"]);
    EXPECT_EQ(parts[0]["shape"], parts[3]["shape"]);
  }
}

TEST(Page, EdgesAreWhereTheSurfaceBends) {
  Subject subject;
  subject.add("box", page_box({0, 0, 0}, {1, 2, 3}));
  for (const std::uint32_t sides : {24u, 100u}) subject.add("round " + std::to_string(sides), page_prism(sides));
  const PageJson shapes = subject.data()["geometry"]["shapes"];
  EXPECT_EQ(indices_of(shapes[0], "edges").size(), 2u * 12u);
  EXPECT_EQ(indices_of(shapes[1], "edges").size(), 2u * 2u * 24u) << "the two circles, not the side";
  EXPECT_EQ(indices_of(shapes[2], "edges").size(), 2u * 2u * 100u);
}

TEST(Page, LargeSurfacesHaveWideIndices) {
  Subject subject;
  subject.add("large", page_prism(30000));
  const PageJson shape = subject.data()["geometry"]["shapes"][0];
  EXPECT_TRUE(shape["wide"].get<bool>());
  const auto triangles = indices_of(shape, "triangles");
  EXPECT_EQ(triangles.size(), 3u * 4u * 30000u);
  EXPECT_GT(*std::max_element(triangles.begin(), triangles.end()), 0xffffu);
}

TEST(Page, TemplateAndPartsMustFit) {
  Subject subject;
  subject.add("peg", page_box({0, 0, 0}, {1, 1, 1}));
  EXPECT_THROW(to_page(subject.plan, subject.assembly, "<html></html>"), Error);
  EXPECT_THROW(to_page(subject.plan, subject.assembly, "@DISMANTLE_DATA@ @DISMANTLE_DATA@"), Error);
  subject.plan.assembly.parts.push_back({1, "ghost", "ghost.obj"});
  EXPECT_THROW(to_page(subject.plan, subject.assembly, kTemplate), InputError);
}

}  // namespace
}  // namespace dismantle

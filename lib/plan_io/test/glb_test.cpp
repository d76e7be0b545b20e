// plan.glb obeys glTF 2.0 by a checker of our own, and shows at every key what the plan says.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/run_context.h"

namespace dismantle {
namespace {

using Json = nlohmann::json;

Mesh box_mesh(const Eigen::Vector3d& lo, const Eigen::Vector3d& hi) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.vertices.emplace_back(i & 1 ? hi.x() : lo.x(), i & 2 ? hi.y() : lo.y(), i & 4 ? hi.z() : lo.z());
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

Mesh cylinder_mesh(std::uint32_t sides) {
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
    m.triangles.push_back({a, b, b + 1});
    m.triangles.push_back({a, b + 1, a + 1});
    m.triangles.push_back({b, a, 2 * sides});
    m.triangles.push_back({a + 1, b + 1, 2 * sides + 1});
  }
  return m;
}

/// Parts in input units `scale` times smaller and moved by `center`.
Assembly assembly_of(const std::vector<std::pair<std::string, Mesh>>& meshes, double scale,
                     const Eigen::Vector3d& center) {
  Assembly a;
  a.normalization = {scale, center};
  for (const auto& [name, mesh] : meshes) {
    Part part;
    part.id = static_cast<PartId>(a.parts.size());
    part.name = name;
    part.mesh = part.surface = std::make_shared<Mesh>(mesh);
    a.parts.push_back(part);
    for (const auto& v : mesh.vertices) a.input_box.extend(a.normalization.to_input(v));
  }
  return a;
}

/// A .glb file taken to pieces. The constructor checks everything that can be checked without the plan.
class Glb {
 public:
  explicit Glb(const std::vector<std::uint8_t>& bytes) {
    EXPECT_EQ(bytes.size() % 4, 0u);
    EXPECT_EQ(u32(bytes, 0), 0x46546C67u);
    EXPECT_EQ(u32(bytes, 4), 2u);
    EXPECT_EQ(u32(bytes, 8), bytes.size());
    const std::size_t json_length = u32(bytes, 12);
    EXPECT_EQ(json_length % 4, 0u);
    EXPECT_EQ(u32(bytes, 16), 0x4E4F534Au);
    json = Json::parse(bytes.begin() + 20, bytes.begin() + 20 + static_cast<std::ptrdiff_t>(json_length));
    const std::size_t at = 20 + json_length;
    EXPECT_EQ(u32(bytes, at + 4), 0x004E4942u);
    EXPECT_EQ(at + 8 + u32(bytes, at), bytes.size());
    binary.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at + 8), bytes.end());
    EXPECT_EQ(json["asset"]["version"], "2.0");
    EXPECT_EQ(json["buffers"].size(), 1u);
    const std::size_t length = json["buffers"][0]["byteLength"];
    EXPECT_LE(length, binary.size());
    EXPECT_LT(binary.size(), length + 4);
    check_accessors();
    check_nodes();
    check_meshes();
    if (json.contains("animations")) check_animation();
    for (std::size_t i = 0; i < json["accessors"].size(); ++i) EXPECT_TRUE(used.contains(i)) << "accessor " << i;
  }

  std::vector<double> read(std::size_t index) const {
    const Json& a = json["accessors"][index];
    const Json& v = json["bufferViews"][a["bufferView"].get<std::size_t>()];
    const std::size_t offset = v["byteOffset"], n = a["count"].get<std::size_t>() * width(a), size = component_size(a);
    std::vector<double> out(n);
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint8_t* p = binary.data() + offset + i * size;
      if (a["componentType"] == 5126) {
        float f = 0;
        std::memcpy(&f, p, 4);
        out[i] = static_cast<double>(f);
      } else if (a["componentType"] == 5125) {
        std::uint32_t u = 0;
        std::memcpy(&u, p, 4);
        out[i] = u;
      } else {
        std::uint16_t u = 0;
        std::memcpy(&u, p, 2);
        out[i] = u;
      }
    }
    return out;
  }

  Json json;
  std::vector<std::uint8_t> binary;
  std::map<std::string, std::size_t> node_of;
  std::map<std::size_t, std::map<std::string, std::size_t>> sampler_of;  // node -> path -> sampler

 private:
  static std::uint32_t u32(const std::vector<std::uint8_t>& b, std::size_t at) {
    return b.at(at) | b.at(at + 1) << 8 | b.at(at + 2) << 16 | static_cast<std::uint32_t>(b.at(at + 3)) << 24;
  }
  static std::size_t component_size(const Json& a) { return a["componentType"] == 5123 ? 2 : 4; }
  static std::size_t width(const Json& a) {
    const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
    return widths.at(a["type"]);
  }

  void check_accessors() {
    const std::size_t length = json["buffers"][0]["byteLength"];
    for (const Json& a : json["accessors"]) {
      const Json& v = json["bufferViews"].at(a["bufferView"].get<std::size_t>());
      EXPECT_EQ(v["buffer"], 0);
      EXPECT_EQ(v["byteOffset"].get<std::size_t>() % 4, 0u);
      EXPECT_LE(v["byteOffset"].get<std::size_t>() + v["byteLength"].get<std::size_t>(), length);
      EXPECT_GT(a["count"].get<std::size_t>(), 0u);
      EXPECT_EQ(a["count"].get<std::size_t>() * width(a) * component_size(a), v["byteLength"].get<std::size_t>());
      const auto index = static_cast<std::size_t>(&a - &json["accessors"][0]);
      const auto values = read(index);
      for (const double x : values) EXPECT_TRUE(std::isfinite(x));
      if (a.contains("min"))
        for (std::size_t c = 0; c < width(a); ++c) {
          double lo = INFINITY, hi = -INFINITY;
          for (std::size_t i = c; i < values.size(); i += width(a)) {
            lo = std::min(lo, values[i]);
            hi = std::max(hi, values[i]);
          }
          EXPECT_EQ(a["min"][c].get<float>(), static_cast<float>(lo));
          EXPECT_EQ(a["max"][c].get<float>(), static_cast<float>(hi));
        }
    }
  }

  void check_nodes() {
    ASSERT_EQ(json["scenes"].size(), 1u);
    EXPECT_EQ(json["scene"], 0);
    EXPECT_EQ(json["scenes"][0]["nodes"], Json::array({0}));
    std::set<std::size_t> children;
    for (const Json& c : json["nodes"][0]["children"]) EXPECT_TRUE(children.insert(c.get<std::size_t>()).second);
    EXPECT_EQ(children.size() + 1, json["nodes"].size());
    EXPECT_FALSE(children.contains(0));
    for (std::size_t i = 1; i < json["nodes"].size(); ++i) {
      EXPECT_TRUE(children.contains(i));
      node_of[json["nodes"][i]["name"]] = i;
    }
  }

  void check_meshes() {
    std::set<std::size_t> shown;
    for (std::size_t i = 1; i < json["nodes"].size(); ++i)
      EXPECT_TRUE(shown.insert(json["nodes"][i]["mesh"].get<std::size_t>()).second);
    EXPECT_EQ(shown.size(), json["meshes"].size());
    for (const Json& m : json["meshes"])
      for (const Json& p : m["primitives"]) {
        const std::size_t position = p["attributes"]["POSITION"], normal = p["attributes"]["NORMAL"],
                          indices = p["indices"];
        used.insert({position, normal, indices});
        EXPECT_LT(p["material"].get<std::size_t>(), json["materials"].size());
        EXPECT_EQ(json["accessors"][position]["count"], json["accessors"][normal]["count"]);
        EXPECT_TRUE(json["accessors"][position].contains("min"));
        EXPECT_EQ(target(position), 34962);
        EXPECT_EQ(target(normal), 34962);
        EXPECT_EQ(target(indices), 34963);
        const std::size_t count = json["accessors"][position]["count"];
        const auto list = read(indices);
        EXPECT_EQ(list.size() % 3, 0u);
        for (const double i : list) EXPECT_LT(i, double(count));
        const auto n = read(normal);
        for (std::size_t i = 0; i < n.size(); i += 3) EXPECT_NEAR(std::hypot(n[i], n[i + 1], n[i + 2]), 1, 1e-5);
      }
    for (const Json& m : json["materials"])
      for (const Json& c : m["pbrMetallicRoughness"]["baseColorFactor"]) {
        EXPECT_GE(c.get<double>(), 0);
        EXPECT_LE(c.get<double>(), 1);
      }
  }
  int target(std::size_t accessor) {
    return json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()]["target"];
  }

  void check_animation() {
    for (const Json& later : json["animations"])
      for (const Json& s : later["samplers"])
        used.insert({s["input"].get<std::size_t>(), s["output"].get<std::size_t>()});
    const Json& animation = json["animations"][0];
    EXPECT_EQ(animation["name"], "disassembly");
    double end = -1;
    for (const Json& c : animation["channels"]) {
      const Json& s = animation["samplers"].at(c["sampler"].get<std::size_t>());
      const std::size_t node = c["target"]["node"];
      EXPECT_LT(node, json["nodes"].size());
      EXPECT_TRUE(sampler_of[node].emplace(c["target"]["path"], c["sampler"]).second);
      EXPECT_EQ(s["interpolation"], "LINEAR");
      used.insert({s["input"].get<std::size_t>(), s["output"].get<std::size_t>()});
      const Json& input = json["accessors"][s["input"].get<std::size_t>()];
      EXPECT_TRUE(input.contains("min") && input.contains("max"));
      EXPECT_EQ(input["count"], json["accessors"][s["output"].get<std::size_t>()]["count"]);
      const auto times = read(s["input"]);
      EXPECT_GE(times.front(), 0);
      for (std::size_t i = 1; i < times.size(); ++i) EXPECT_LT(times[i - 1], times[i]);
      EXPECT_TRUE(end < 0 || end == times.back()) << "all tracks end together";
      end = times.back();
      const auto values = read(s["output"]);
      if (c["target"]["path"] == "rotation")
        for (std::size_t i = 0; i < values.size(); i += 4) {
          EXPECT_NEAR(std::hypot(std::hypot(values[i], values[i + 1]), std::hypot(values[i + 2], values[i + 3])), 1,
                      1e-5);
          if (i > 0) {
            const double dot = values[i] * values[i - 4] + values[i + 1] * values[i - 3] +
                               values[i + 2] * values[i - 2] + values[i + 3] * values[i - 1];
            EXPECT_GE(dot, 0);
          }
        }
    }
  }
  std::set<std::size_t> used;
};

Eigen::Vector3d vector_of(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

PlanStep step_of(unsigned number, std::vector<PlanMove> moves) {
  PlanStep s;
  s.step = number;
  for (const auto& m : moves) s.separates.push_back({m.part});
  s.moves = std::move(moves);
  return s;
}

std::vector<Pose> straight(const Eigen::Vector3d& way, std::size_t n) {
  std::vector<Pose> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i].t = way * (double(i) / double(n - 1));
  return out;
}

TEST(Glb, AssemblyIsTheSecondAnimation) {
  const Assembly assembly = assembly_of(
      {{"a", box_mesh({-1, -1, -1}, {1, 1, 1})}, {"base", box_mesh({-5, -5, -2}, {5, 5, -1})}}, 1, {0, 0, 0});
  Plan plan;
  plan.disassembly = {step_of(1, {{"a", straight({0, 0, 9}, 5)}})};
  EXPECT_EQ(Glb(to_glb(plan, assembly)).json["animations"].size(), 1u);
  plan.assembly_steps = plan.disassembly;
  auto& poses = plan.assembly_steps[0].moves[0].poses;
  std::reverse(poses.begin(), poses.end());
  poses.insert(poses.begin(), Pose{{12, 0, 0}, Eigen::Quaterniond::Identity()});
  const Glb glb(to_glb(plan, assembly));
  ASSERT_EQ(glb.json["animations"].size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Json& animation = glb.json["animations"][i];
    EXPECT_EQ(animation["name"], i == 0 ? "disassembly" : "assembly");
    EXPECT_EQ(animation["extras"]["kind"], animation["name"]);
    ASSERT_EQ(animation["extras"]["steps"].size(), 1u);
    const Json& step = animation["extras"]["steps"][0];
    EXPECT_EQ(step["step"], 1);
    EXPECT_EQ(step["parts"], Json::array({"a"}));
    EXPECT_LT(step["begin"], step["end"]);
  }
  // It begins where the part lies; nodes count from the middle of the assembly, half a unit below the part's.
  const Json& sampler = glb.json["animations"][1]["samplers"][0];
  EXPECT_EQ(vector_of(Json(glb.read(sampler["output"]))), Eigen::Vector3d(12, 0, 0.5));
}

TEST(Glb, EveryKeyPutsTheGeometryWhereThePlanSays) {
  Rng rng(5);
  for (int trial = 0; trial < 30; ++trial) {
    // The last trials: millimetre parts a hundred kilometres from the origin.
    const bool far = trial >= 20;
    const Eigen::Vector3d center = far ? Eigen::Vector3d(1e8, -1e8, 3e7) : Eigen::Vector3d(1, 2, 3);
    const Assembly assembly = assembly_of({{"a b", box_mesh({-1, -1, -1}, {1, 1, 1})},
                                           {"çylinder", cylinder_mesh(24)},
                                           {"base", box_mesh({-5, -5, -2}, {5, 5, -1})}},
                                          10 / (far ? 50.0 : 0.001 + rng.uniform()), center);
    const double size = assembly.input_box.size().maxCoeff();
    Plan plan;
    plan.generator_version = "0.1.0";
    std::vector<Pose> turn(1 + 2 + rng.below(30));
    for (std::size_t k = 1; k < turn.size(); ++k) {
      const Pose about{Eigen::Vector3d::Zero(), rotation_from_vector({0.1 * rng.normal(), 0.1 * rng.normal(), 0.2})};
      const Pose there{center, Eigen::Quaterniond::Identity()}, back{-center, Eigen::Quaterniond::Identity()};
      turn[k] = there * about * back * turn[k - 1];
      turn[k].t += Eigen::Vector3d(0, 0, 0.05 * size);
      if (k % 3 == 0) turn[k].q.coeffs() *= -1;  // the same rotation
    }
    plan.disassembly = {step_of(1, {{"a b", straight({0, 0, size}, 5)}, {"çylinder", straight({0, 0, size}, 5)}}),
                        step_of(2, {{"çylinder", turn}})};
    for (auto& p : plan.disassembly[1].moves[0].poses) p = p * Pose{{0, 0, size}, Eigen::Quaterniond::Identity()};
    const Glb glb(to_glb(plan, assembly));
    ASSERT_EQ(glb.node_of.size(), 3u);
    EXPECT_FALSE(glb.sampler_of.contains(glb.node_of.at("base")));
    EXPECT_FALSE(glb.sampler_of.at(glb.node_of.at("a b")).contains("rotation")) << "nothing turns";

    const Eigen::Vector3d origin = vector_of(glb.json["nodes"][0]["translation"]);
    for (const Part& part : assembly.parts) {
      const std::size_t node = glb.node_of.at(part.name);
      const Json& n = glb.json["nodes"][node];
      const Json& primitive = glb.json["meshes"][n["mesh"].get<std::size_t>()]["primitives"][0];
      const auto p = glb.read(primitive["attributes"]["POSITION"]);
      const auto indices = glb.read(primitive["indices"]);
      ASSERT_EQ(indices.size(), 3 * part.mesh->triangles.size());

      std::vector<Pose> shown = {{vector_of(n["translation"]), Eigen::Quaterniond::Identity()}};
      std::vector<Pose> planned = {Pose{}};
      if (glb.sampler_of.contains(node)) {
        const auto& samplers = glb.json["animations"][0]["samplers"];
        const auto t = glb.read(samplers[glb.sampler_of.at(node).at("translation")]["output"]);
        std::vector<double> q;
        if (glb.sampler_of.at(node).contains("rotation"))
          q = glb.read(samplers[glb.sampler_of.at(node).at("rotation")]["output"]);
        for (std::size_t k = 0; k < t.size() / 3; ++k)
          shown.push_back({{t[3 * k], t[3 * k + 1], t[3 * k + 2]},
                           q.empty() ? Eigen::Quaterniond::Identity()
                                     : Eigen::Quaterniond(q[4 * k + 3], q[4 * k], q[4 * k + 1], q[4 * k + 2])});
        for (const auto& s : plan.disassembly)
          for (const auto& m : s.moves)
            if (m.part == part.name) planned.insert(planned.end(), m.poses.begin(), m.poses.end());
        planned.push_back(planned.back());
      }
      ASSERT_EQ(shown.size(), planned.size());
      for (std::size_t k = 0; k < shown.size(); ++k)
        for (std::size_t i = 0; i < indices.size(); i += 7) {
          const auto v = static_cast<std::size_t>(indices[i]);
          const Eigen::Vector3d at = origin + shown[k] * Eigen::Vector3d(p[3 * v], p[3 * v + 1], p[3 * v + 2]);
          const Eigen::Vector3d vertex = part.mesh->vertices[part.mesh->triangles[i / 3][i % 3]];
          const Eigen::Vector3d expected = planned[k] * assembly.normalization.to_input(vertex);
          // Doubles at 1e8 resolve 1e-8 and rotate with an error of the same order.
          EXPECT_LT((at - expected).norm(), 2e-6 * size + (far ? 1e-6 : 0)) << part.name << " key " << k;
        }
    }
  }
}

TEST(Glb, NormalsAreSmoothOnRoundsAndHardOnEdges) {
  const Assembly assembly =
      assembly_of({{"cylinder", cylinder_mesh(24)}, {"box", box_mesh({3, 3, 3}, {4, 4, 4})}}, 1, {0, 0, 0});
  const Glb glb(to_glb(Plan{}, assembly));
  const auto attribute = [&](const std::string& part, const char* name) {
    return glb.read(glb.json["meshes"][glb.json["nodes"][glb.node_of.at(part)]["mesh"].get<std::size_t>()]["primitives"]
                            [0]["attributes"][name]);
  };
  EXPECT_EQ(attribute("box", "POSITION").size(), 24u * 3) << "four corners for each of six faces";
  const auto p = attribute("cylinder", "POSITION"), n = attribute("cylinder", "NORMAL");
  EXPECT_EQ(p.size(), (4u * 24 + 2) * 3) << "the rim belongs to the side and to the cap";
  for (std::size_t i = 0; i < n.size(); i += 3) {
    if (std::abs(n[i + 2]) > 0.5) continue;  // cap
    EXPECT_NEAR(n[i + 2], 0, 1e-6);
    EXPECT_NEAR(n[i] * p[i] + n[i + 1] * p[i + 1], 1, 1e-5) << "the side's normals are radial";
  }
}

TEST(Glb, APlanWithoutStepsHasNoAnimation) {
  const Glb glb(to_glb(Plan{}, assembly_of({{"a", box_mesh({0, 0, 0}, {1, 1, 1})}}, 2, {7, 7, 7})));
  EXPECT_FALSE(glb.json.contains("animations"));
}

TEST(Glb, LargeMeshesGetLongIndicesAndFlatTrianglesAreLeftOut) {
  Mesh m = cylinder_mesh(40'000);
  m.triangles.push_back({0, 1, 0});
  const Glb glb(to_glb(Plan{}, assembly_of({{"a", m}}, 1, {0, 0, 0})));
  const Json& primitive = glb.json["meshes"][0]["primitives"][0];
  EXPECT_EQ(glb.json["accessors"][primitive["indices"].get<std::size_t>()]["componentType"], 5125);
  EXPECT_EQ(glb.json["accessors"][primitive["indices"].get<std::size_t>()]["count"], 3 * (m.triangles.size() - 1));
}

TEST(Glb, ColoursTellLeaversApartAndWhatStaysIsGrey) {
  std::vector<std::pair<std::string, Mesh>> parts;
  Plan plan;
  for (unsigned i = 0; i < 9; ++i) {
    parts.emplace_back("p" + std::to_string(i), box_mesh({2.0 * i, 0, 0}, {2.0 * i + 1, 1, 1}));
    if (i < 8) plan.disassembly.push_back(step_of(i + 1, {{parts.back().first, straight({0, 0, 9}, 3)}}));
  }
  const Glb glb(to_glb(plan, assembly_of(parts, 1, {0, 0, 0})));
  std::vector<Eigen::Vector3d> colours;
  for (const Json& m : glb.json["materials"]) {
    const Json& c = m["pbrMetallicRoughness"]["baseColorFactor"];
    for (const auto& other : colours) EXPECT_GT((other - vector_of(c)).norm(), 0.1);
    colours.push_back(vector_of(c));
  }
  EXPECT_EQ(colours.back().minCoeff(), colours.back().maxCoeff());
}

TEST(Glb, SamePlanSameBytes) {
  Plan plan;
  plan.disassembly = {step_of(1, {{"a", straight({0, 0, 3}, 9)}})};
  const Assembly assembly =
      assembly_of({{"a", cylinder_mesh(32)}, {"b", box_mesh({3, 3, 3}, {4, 4, 4})}}, 1, {0, 0, 0});
  EXPECT_EQ(to_glb(plan, assembly), to_glb(plan, assembly));
}

TEST(Glb, APartThatTheAssemblyDoesNotHaveIsNamed) {
  Plan plan;
  plan.disassembly = {step_of(1, {{"ghost", straight({0, 0, 3}, 2)}})};
  try {
    to_glb(plan, assembly_of({{"a", cylinder_mesh(8)}}, 1, {0, 0, 0}));
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(e.subject(), "ghost");
  }
}

}  // namespace
}  // namespace dismantle

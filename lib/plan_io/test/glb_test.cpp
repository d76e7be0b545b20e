// plan.glb obeys glTF 2.0 by a checker of our own, and shows at every key what the plan says.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/plan_io/animation.h"
#include "dismantle/run_context.h"
#include "dismantle/testing/shapes.h"
#include "glb_reader.h"
#include "random_plan.h"

namespace dismantle {
namespace {

using Json = nlohmann::json;
using shapes::box;

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

PlanStep step_of(unsigned number, std::vector<PlanMove> moves) {
  PlanStep s;
  s.step = number;
  for (const auto& m : moves) s.separates.push_back({m.part});
  s.moves = std::move(moves);
  return s;
}

std::vector<Pose> straight(const Eigen::Vector3d& displacement, std::size_t n) {
  std::vector<Pose> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i].t = displacement * (double(i) / double(n - 1));
  return out;
}

Eigen::Quaterniond quaternion_of(const Json& json) {
  return Eigen::Quaterniond(json[3].get<double>(), json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
}

TEST(Glb, AssemblyIsTheSecondAnimation) {
  const Assembly assembly =
      assembly_of_meshes({{"a", box({-1, -1, -1}, {1, 1, 1})}, {"base", box({-5, -5, -2}, {5, 5, -1})}}, 1, {0, 0, 0});
  Plan plan;
  plan.assembly = described(assembly);
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
    const Assembly assembly = assembly_of_meshes({{"a b", box({-1, -1, -1}, {1, 1, 1})},
                                                  {"çylinder", cylinder_mesh(24)},
                                                  {"base", box({-5, -5, -2}, {5, 5, -1})}},
                                                 10 / (far ? 50.0 : 0.001 + rng.uniform()), center);
    const double size = assembly.input_box.size().maxCoeff();
    Plan plan;
    plan.assembly = described(assembly);
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

    // Input units in Z up below the root, metres in Y up above: (x, y, z) becomes (x, z, -y) thousandths.
    const Json& root = glb.json["nodes"][0];
    const Pose turned{vector_of(root["translation"]), quaternion_of(root["rotation"])};
    EXPECT_EQ(root["scale"], Json::array({1e-3, 1e-3, 1e-3}));
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
          const Eigen::Vector3d at =
              turned * (1e-3 * (shown[k] * Eigen::Vector3d(p[3 * v], p[3 * v + 1], p[3 * v + 2])));
          const Eigen::Vector3d vertex = part.mesh->vertices[part.mesh->triangles[i / 3][i % 3]];
          const Eigen::Vector3d input = planned[k] * assembly.normalization.to_input(vertex);
          const Eigen::Vector3d expected = 1e-3 * Eigen::Vector3d(input.x(), input.z(), -input.y());
          // Doubles at 1e8 resolve 1e-8 and rotate with an error of the same order.
          EXPECT_LT((at - expected).norm(), 1e-3 * (2e-6 * size + (far ? 1e-6 : 0))) << part.name << " key " << k;
        }
    }
  }
}

/// A part turned and shifted, with its vertices in the same order.
Mesh relocated(const Mesh& mesh, const Pose& pose) {
  Mesh out = mesh;
  for (auto& v : out.vertices) v = pose * v;
  return out;
}

TEST(Glb, CongruentPartsShareASurfaceAndStandWhereTheyStood) {
  Rng rng(8);
  for (int trial = 0; trial < 20; ++trial) {
    const Mesh shape = cylinder_mesh(7);
    std::vector<std::pair<std::string, Mesh>> parts;
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector3d axis(rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1));
      const Pose pose{{4.0 * i, rng.uniform(-5, 5), rng.uniform(-5, 5)}, rotation_from_vector(2 * axis)};
      parts.emplace_back("p" + std::to_string(i), relocated(shape, pose));
    }
    Assembly assembly = assembly_of_meshes(parts, 2, {1, 2, 3});
    assembly.unit = "inch";
    for (Part& part : assembly.parts) part.colour = Rgba{static_cast<std::uint8_t>(part.id < 3 ? 10 : 200), 40, 60};
    Plan plan;
    plan.assembly = described(assembly);
    plan.disassembly = {step_of(1, {{"p4", straight({0, 0, 9}, 4)}})};
    const Glb glb(to_glb(plan, assembly));
    EXPECT_EQ(glb.json["meshes"].size(), 2u) << "one shape in two colours";
    EXPECT_EQ(glb.json["meshes"][0]["primitives"][0]["attributes"],
              glb.json["meshes"][1]["primitives"][0]["attributes"]);
    const Json& root = glb.json["nodes"][0];
    EXPECT_EQ(root["scale"][0], 0.0254);
    EXPECT_EQ(root["extras"]["unit_known"], true);
    const Pose turned{vector_of(root["translation"]), quaternion_of(root["rotation"])};
    for (const Part& part : assembly.parts) {
      const Json& n = glb.json["nodes"][glb.node_of.at(part.name)];
      const Json& primitive = glb.json["meshes"][n["mesh"].get<std::size_t>()]["primitives"][0];
      const auto p = glb.read(primitive["attributes"]["POSITION"]);
      const auto indices = glb.read(primitive["indices"]);
      const Pose node{vector_of(n["translation"]),
                      n.contains("rotation") ? quaternion_of(n["rotation"]) : Eigen::Quaterniond::Identity()};
      for (std::size_t i = 0; i < indices.size(); ++i) {
        const auto v = static_cast<std::size_t>(indices[i]);
        const Eigen::Vector3d at = turned * (0.0254 * (node * Eigen::Vector3d(p[3 * v], p[3 * v + 1], p[3 * v + 2])));
        const Eigen::Vector3d in =
            assembly.normalization.to_input(part.mesh->vertices[part.mesh->triangles[i / 3][i % 3]]);
        EXPECT_LT((at - 0.0254 * Eigen::Vector3d(in.x(), in.z(), -in.y())).norm(), 1e-6);
      }
    }
    // The animation begins where the node stands, and does not turn what the plan only shifts.
    const Json& animation = glb.json["animations"][0];
    ASSERT_EQ(animation["channels"].size(), 1u);
    const auto t = glb.read(animation["samplers"][0]["output"].get<std::size_t>());
    EXPECT_LT(
        (Eigen::Vector3d(t[0], t[1], t[2]) - vector_of(glb.json["nodes"][glb.node_of.at("p4")]["translation"])).norm(),
        1e-5);
  }
}

TEST(Glb, ExplodedPartsAreClearOfEachOther) {
  Rng rng(9);
  for (int trial = 0; trial < 20; ++trial) {
    // A stack of plates of any size that leave upwards, the topmost first.
    std::vector<std::pair<std::string, Mesh>> parts;
    Plan plan;
    for (unsigned i = 0; i < 6; ++i) {
      const double w = rng.uniform(1, 4);
      parts.emplace_back("p" + std::to_string(i), box({-w, -w, double(i)}, {w, w, i + 1.0}));
      if (i > 0) plan.disassembly.push_back(step_of(i, {{"p" + std::to_string(6 - i), straight({0, 0, 9}, 3)}}));
    }
    const Assembly assembly = assembly_of_meshes(parts, 2, {0, 0, 0});
    plan.assembly = described(assembly);
    const Glb glb(to_exploded_glb(plan, assembly, input_frame(assembly)));
    EXPECT_FALSE(glb.json.contains("animations"));
    double top = -1e9;
    for (unsigned i = 0; i < 6; ++i) {
      const double z = vector_of(glb.json["nodes"][glb.node_of.at("p" + std::to_string(i))]["translation"]).z();
      EXPECT_GT(z - 0.25, top) << "plates are half a unit thick in input units, and apart";
      top = z + 0.25;
    }
  }
}

TEST(Glb, AnUnknownUnitIsNamed) {
  Assembly assembly = assembly_of_meshes({{"a", cylinder_mesh(8)}}, 1, {0, 0, 0});
  assembly.unit = "furlong";
  EXPECT_THROW(to_glb(Plan{}, assembly), InputError);
}

TEST(Glb, NormalsAreSmoothOnRoundsAndHardOnEdges) {
  const Assembly assembly =
      assembly_of_meshes({{"cylinder", cylinder_mesh(24)}, {"box", box({3, 3, 3}, {4, 4, 4})}}, 1, {0, 0, 0});
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
  const Glb glb(to_glb(Plan{}, assembly_of_meshes({{"a", box({0, 0, 0}, {1, 1, 1})}}, 2, {7, 7, 7})));
  EXPECT_FALSE(glb.json.contains("animations"));
}

TEST(Glb, LargeMeshesGetLongIndicesAndFlatTrianglesAreLeftOut) {
  Mesh m = cylinder_mesh(40'000);
  m.triangles.push_back({0, 1, 0});
  const Glb glb(to_glb(Plan{}, assembly_of_meshes({{"a", m}}, 1, {0, 0, 0})));
  const Json& primitive = glb.json["meshes"][0]["primitives"][0];
  EXPECT_EQ(glb.json["accessors"][primitive["indices"].get<std::size_t>()]["componentType"], 5125);
  EXPECT_EQ(glb.json["accessors"][primitive["indices"].get<std::size_t>()]["count"], 3 * (m.triangles.size() - 1));
}

TEST(Glb, ColoursTellLeaversApartAndWhatStaysIsGrey) {
  std::vector<std::pair<std::string, Mesh>> parts;
  Plan plan;
  for (unsigned i = 0; i < 9; ++i) {
    parts.emplace_back("p" + std::to_string(i), box({2.0 * i, 0, 0}, {2.0 * i + 1, 1, 1}));
    if (i < 8) plan.disassembly.push_back(step_of(i + 1, {{parts.back().first, straight({0, 0, 9}, 3)}}));
  }
  const Assembly assembly = assembly_of_meshes(parts, 1, {0, 0, 0});
  plan.assembly = described(assembly);
  const Glb glb(to_glb(plan, assembly));
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
      assembly_of_meshes({{"a", cylinder_mesh(32)}, {"b", box({3, 3, 3}, {4, 4, 4})}}, 1, {0, 0, 0});
  plan.assembly = described(assembly);
  EXPECT_EQ(to_glb(plan, assembly), to_glb(plan, assembly));
}

TEST(Glb, APartThatTheAssemblyDoesNotHaveIsNamed) {
  Plan plan;
  plan.disassembly = {step_of(1, {{"ghost", straight({0, 0, 3}, 2)}})};
  try {
    to_glb(plan, assembly_of_meshes({{"a", cylinder_mesh(8)}}, 1, {0, 0, 0}));
    ADD_FAILURE();
  } catch (const InputError& e) {
    EXPECT_EQ(e.subject(), "ghost");
  }
}

}  // namespace
}  // namespace dismantle

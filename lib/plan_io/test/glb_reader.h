/// Reads a .glb file and checks that it obeys glTF 2.0.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace dismantle {

/// The content of a .glb file. The constructor checks all that can be checked without the plan.
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
    json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + static_cast<std::ptrdiff_t>(json_length));
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
    const nlohmann::json& a = json["accessors"][index];
    const nlohmann::json& v = json["bufferViews"][a["bufferView"].get<std::size_t>()];
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

  nlohmann::json json;
  std::vector<std::uint8_t> binary;
  std::map<std::string, std::size_t> node_of;
  std::map<std::size_t, std::map<std::string, std::size_t>> sampler_of;  // node -> path -> sampler

 private:
  static std::uint32_t u32(const std::vector<std::uint8_t>& b, std::size_t at) {
    return b.at(at) | b.at(at + 1) << 8 | b.at(at + 2) << 16 | static_cast<std::uint32_t>(b.at(at + 3)) << 24;
  }
  static std::size_t component_size(const nlohmann::json& a) { return a["componentType"] == 5123 ? 2 : 4; }
  static std::size_t width(const nlohmann::json& a) {
    const std::map<std::string, std::size_t> widths = {{"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}};
    return widths.at(a["type"]);
  }

  void check_accessors() {
    const std::size_t length = json["buffers"][0]["byteLength"];
    for (const nlohmann::json& a : json["accessors"]) {
      const nlohmann::json& v = json["bufferViews"].at(a["bufferView"].get<std::size_t>());
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
    EXPECT_EQ(json["scenes"][0]["nodes"], nlohmann::json::array({0}));
    std::set<std::size_t> children;
    for (const nlohmann::json& c : json["nodes"][0]["children"])
      EXPECT_TRUE(children.insert(c.get<std::size_t>()).second);
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
      shown.insert(json["nodes"][i]["mesh"].get<std::size_t>());
    EXPECT_EQ(shown.size(), json["meshes"].size());
    for (const nlohmann::json& m : json["meshes"])
      for (const nlohmann::json& p : m["primitives"]) {
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
    for (const nlohmann::json& m : json["materials"])
      for (const nlohmann::json& c : m["pbrMetallicRoughness"]["baseColorFactor"]) {
        EXPECT_GE(c.get<double>(), 0);
        EXPECT_LE(c.get<double>(), 1);
      }
  }
  int target(std::size_t accessor) {
    return json["bufferViews"][json["accessors"][accessor]["bufferView"].get<std::size_t>()]["target"];
  }

  void check_animation() {
    for (const nlohmann::json& later : json["animations"])
      for (const nlohmann::json& s : later["samplers"])
        used.insert({s["input"].get<std::size_t>(), s["output"].get<std::size_t>()});
    const nlohmann::json& animation = json["animations"][0];
    EXPECT_EQ(animation["name"], "disassembly");
    double end = -1;
    for (const nlohmann::json& c : animation["channels"]) {
      const nlohmann::json& s = animation["samplers"].at(c["sampler"].get<std::size_t>());
      const std::size_t node = c["target"]["node"];
      EXPECT_LT(node, json["nodes"].size());
      EXPECT_TRUE(sampler_of[node].emplace(c["target"]["path"], c["sampler"]).second);
      EXPECT_EQ(s["interpolation"], "LINEAR");
      used.insert({s["input"].get<std::size_t>(), s["output"].get<std::size_t>()});
      const nlohmann::json& input = json["accessors"][s["input"].get<std::size_t>()];
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

inline Eigen::Vector3d vector_of(const nlohmann::json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

}  // namespace dismantle

/// Mutations of JSON that keep it JSON: numbers become others, members and items are copied, moved and left out. Bytes alone
/// hardly ever get past the syntax.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace dismantle::fuzz {

class JsonMutator {
 public:
  using Json = nlohmann::ordered_json;
  explicit JsonMutator(unsigned seed) : random_(seed) {}

  /// Changes one to three places.
  void mutate(Json& root) {
    for (std::size_t n = 1 + below(3); n-- > 0;) {
      std::vector<Json*> nodes;
      collect(root, nodes);
      change(*nodes[below(nodes.size())], *nodes[below(nodes.size())]);
    }
  }

 private:
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }

  static void collect(Json& node, std::vector<Json*>& out) {
    out.push_back(&node);
    if (node.is_structured())
      for (auto& child : node) collect(child, out);
  }

  void change(Json& node, const Json& other) {
    if (node.is_number() && below(4) != 0) return number(node);
    if (node.is_array() && !node.empty() && below(2) == 0) return array(node);
    if (node.is_object() && !node.empty() && below(2) == 0) {
      auto member = node.begin();
      std::advance(member, static_cast<std::ptrdiff_t>(below(node.size())));
      node.erase(member);
      return;
    }
    if (node.is_string() && below(2) == 0) {
      node = node.get<std::string>() + "/../x";
      return;
    }
    const Json copy = other;  // which may hold the node
    node = copy;
  }

  void number(Json& node) {
    static constexpr double kValues[] = {0,    1,     -1,     0.5,  -0.5, 1e-9, 1e9,  1e300, -1e300,
                                         1e16, 1e-300, 1.0e-3, 2147483648.0, 4294967296.0, 1.8446744073709552e19};
    switch (below(4)) {
      case 0:
        node = kValues[below(std::size(kValues))];
        break;
      case 1:
        node = node.get<double>() * 2;
        break;
      case 2:
        node = static_cast<std::int64_t>(below(1000)) - 2;
        break;
      default:
        node = node.get<double>() + std::normal_distribution<double>(0, 0.1)(random_);
    }
  }

  void array(Json& node) {
    const auto at = static_cast<std::ptrdiff_t>(below(node.size()));
    switch (below(3)) {
      case 0:
        node.erase(node.begin() + at);
        break;
      case 1:
        node.insert(node.begin() + at, Json(node[static_cast<std::size_t>(at)]));
        break;
      default:
        std::swap(node[static_cast<std::size_t>(at)], node[below(node.size())]);
    }
  }

  std::mt19937 random_;
};

}  // namespace dismantle::fuzz

// plan.json -> Plan: strict, every problem is reported with its location in the file.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/plan_file.h"
#include "json/parse_json.h"
#include "json/plan_fields.h"

namespace dismantle {
namespace plan_json {
namespace {

// What must hold between the keys of an object, found by its type.

template <class T>
void check(const Place&, const T&) {}

void check(const Place& place, const PlanPart& p) {
  if (p.id != place.parts().size())
    place.at("id").fail(fmt::format("expected {}: parts are numbered in order", place.parts().size()));
  if (!place.parts().insert(p.name).second) place.at("name").fail(fmt::format("there are two parts '{}'", p.name));
}

void check(const Place& place, const PlanAssembly&) {
  for (const Place& stated : place.at("parts").items()) {
    if (!stated.has("fastens")) continue;
    for (const auto& [key, names] : stated.at("fastens").members())
      for (const Place& name : names.items()) part(name);
  }
}

void check(const Place& place, const PlanOverlap& o) {
  if (o.a == o.b) place.fail("a part cannot overlap itself");
}

void check(const Place& place, const PlanCertificate& c) {
  if (c.parts.size() < 2) place.at("parts").fail("expected two parts at least");
  if (place.has("poses") && c.poses.size() != c.parts.size()) place.at("poses").fail("expected one pose for each part");
}

void check(const Place& place, const PlanStep& s) {
  const Place moves = place.at("moves");
  if (s.moves.empty()) moves.fail("expected at least one move");
  const std::size_t poses = s.moves.front().poses.size();
  std::set<std::string> seen;
  for (std::size_t i = 0; i < s.moves.size(); ++i) {
    const PlanMove& m = s.moves[i];
    if (!seen.insert(m.part).second)
      moves.at(i).at("part").fail(fmt::format("part '{}' moves twice in one step", m.part));
    if (m.poses.size() != poses)
      moves.at(i).at("poses").fail(
          fmt::format("{} poses, but {} in the first move of this step", m.poses.size(), poses));
  }
  if (s.transfer >= poses)
    place.at(place.has("valid_to") ? "valid_to" : "transfer")
        .fail(fmt::format("expected less than {}, the number of poses", poses));
  for (std::size_t i = 0; i < s.after.size(); ++i)
    if (s.after[i] == 0 || s.after[i] >= s.step) place.at("after").at(i).fail("expected the number of an earlier step");
}

void check(const Place& place, const Plan& plan) {
  const auto certificate = [&](const auto& owner, const Place& at) {
    if (owner.certificate && *owner.certificate >= plan.certificates.size())
      at.at("certificate").fail("there is no such certificate");
  };
  const auto steps = [&](const std::vector<PlanStep>& all, const Place& at) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].step != i + 1)
        at.at(i).at("step").fail(fmt::format("expected {}: steps are numbered in order", i + 1));
      if (all[i].forced) certificate(*all[i].forced, at.at(i).at("forced"));
    }
  };
  for (std::size_t i = 0; i < plan.objective.alternatives.size(); ++i) {
    const PlanAlternative& other = plan.objective.alternatives[i];
    const Place at = place.at("objective").at("alternatives").at(i);
    const std::size_t n = plan.disassembly.size();
    if (other.step > n || other.place > n || (other.step > 0) != (other.place > 0) ||
        (other.step > 0 && other.step == other.place))
      at.fail("expected the numbers of two steps of the disassembly, or none");
    const bool same =
        std::ranges::equal(other.checks, plan.objective.checks, {}, &PlanVerdict::type, &PlanObjectiveItem::type);
    if (!same) at.at("checks").fail("expected the checks of the objective");
  }
  steps(plan.disassembly, place.at("disassembly"));
  steps(plan.assembly_steps, place.at("assembly_steps"));
  for (std::size_t i = 0; i < plan.unsolved.size(); ++i) certificate(plan.unsolved[i], place.at("unsolved").at(i));
}

/// Reads one object, and checks its keys before its values.
class Reader {
 public:
  template <class T, class Describe>
  static void read_object(const Place& place, T& out, Describe describe) {
    place.expect(place.json().is_object(), "an object");
    Reader reader(place, Pass::keys);
    describe(reader, out);
    for (const auto& item : place.json().items())
      if (!reader.known_.contains(item.key())) place.fail(fmt::format("unknown key '{}'", item.key()));
    reader.pass_ = Pass::values;
    describe(reader, out);
    check(place, out);
  }

  /// An object of a type with `fields`.
  template <class T>
  static void read(const Place& place, T& out) {
    read_object(place, out, [](auto& v, T& x) { fields(v, x); });
  }

  template <class T, class Rule = ByType>
  void operator()(const char* key, T&& member, Presence presence = required, Rule rule = {}) {
    if (!has_value(key, presence)) return;
    if constexpr (std::is_same_v<Rule, ByType>)
      read(place_.at(key), member);
    else
      member = rule(place_.at(key));
  }
  template <class T, class Describe>
  void list(const char* key, std::vector<T>& member, Describe describe) {
    if (!has_value(key, required)) return;
    for (const Place& item : place_.at(key).items()) read_object(item, member.emplace_back(), describe);
  }
  template <class Describe>
  void object(const char* key, Presence presence, Describe describe) {
    int none = 0;
    if (has_value(key, presence)) read_object(place_.at(key), none, [&](Reader& v, int&) { describe(v); });
  }
  template <class T>
  void inlined(std::optional<T>& member) {
    Reader keys(place_, Pass::any_key);
    T value{};
    fields(keys, value);
    if (!keys.known_.empty()) fields(*this, member ? *member : member.emplace());
  }

 private:
  enum class Pass { any_key, keys, values };

  Reader(const Place& place, Pass pass) : place_(place), pass_(pass) {}

  bool has_value(const char* key, Presence presence) {
    if (presence == unknown) return false;
    if (pass_ == Pass::values) return place_.has(key);
    if (pass_ == Pass::keys && presence == required && !place_.has(key))
      place_.fail(fmt::format("'{}' is missing", key));
    if (pass_ == Pass::keys || place_.has(key)) known_.insert(key);
    return false;
  }

  static void read(const Place& place, std::string& out) { out = text(place); }
  static void read(const Place& place, bool& out) { out = truth(place); }
  static void read(const Place& place, double& out) { out = number(place); }
  static void read(const Place& place, unsigned& out) { out = count<unsigned>(place); }
  static void read(const Place& place, std::uint64_t& out) { out = count<std::uint64_t>(place); }
  static void read(const Place& place, Eigen::Vector3d& out) { out = vector(place); }
  static void read(const Place& place, Pose& out) { out = pose(place); }
  static void read(const Place& place, ParamValue& out) { out = parameter(place); }
  template <class T>
  static void read(const Place& place, std::optional<T>& out) {
    read(place, out.emplace());
  }
  template <class T>
  static void read(const Place& place, std::vector<T>& out) {
    for (const Place& item : place.items()) read(item, out.emplace_back());
  }
  template <class T>
  static void read(const Place& place, std::map<std::string, T>& out) {
    for (const auto& [key, value] : place.members()) read(value, out[key]);
  }

  const Place& place_;
  Pass pass_;
  std::set<std::string> known_{};
};

}  // namespace
}  // namespace plan_json

Plan plan_from_json(const std::string& text, const std::string& source) {
  using namespace plan_json;
  const Json json = parse_json(text, source);
  Source from{source};
  const Place root(json, from);
  root.expect(json.is_object(), "an object");
  if (!json.contains("format") || json["format"] != kFormat)
    throw InputError(source, fmt::format("not a plan: expected \"format\": \"{}\"", kFormat));
  if (!json.contains("version")) root.fail("'version' is missing");
  if (const auto version = count<std::uint64_t>(root.at("version")); version != kVersion)
    root.at("version").fail(fmt::format("this program reads version {} of the plan format, not {}", kVersion, version));
  Plan plan;
  Reader::read(root, plan);
  return plan;
}

}  // namespace dismantle

// Plan -> plan.json (docs/plan-format.md).
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <variant>

#include "dismantle/plan.h"
#include "dismantle/plan_io/plan_file.h"
#include "json/json_text.h"
#include "json/plan_fields.h"
#include "json/verdicts_json.h"

namespace dismantle {
namespace plan_json {
namespace {

Json pose_json(const Pose& p, double sign) {
  return Json::array({p.t.x(), p.t.y(), p.t.z(), sign * p.q.w(), sign * p.q.x(), sign * p.q.y(), sign * p.q.z()});
}

/// +1 or -1: makes the first of w, x, y, z that is not zero positive.
double canonical_sign(const Eigen::Quaterniond& q) {
  for (const double c : {q.w(), q.x(), q.y(), q.z()})
    if (c != 0) return c < 0 ? -1 : 1;
  return 1;
}

/// Writes one object.
class Writer {
 public:
  /// A number, the name of an enumerator, or an object of a type with `fields`.
  template <class T>
  static Json json(const T& value) {
    if constexpr (std::is_arithmetic_v<T>) {
      return value;
    } else if constexpr (std::is_enum_v<T>) {
      return std::string(to_string(value));
    } else {
      Writer out;
      fields(out, value);
      return std::move(out.json_);
    }
  }

  template <class T, class Rule = ByType>
  void operator()(const char* key, const T& member, Presence presence = required, const Rule& = {}) {
    if (presence == unwritten || presence == unknown || (presence == if_set && !is_set(member))) return;
    if constexpr (requires { Rule::write(member); })
      json_[key] = Rule::write(member);
    else
      json_[key] = json(member);
  }
  template <class T, class Describe>
  void list(const char* key, const std::vector<T>& member, Describe describe) {
    Json& out = json_[key] = Json::array();
    for (const T& item : member) {
      Writer one;
      describe(one, item);
      out.push_back(std::move(one.json_));
    }
  }
  template <class Describe>
  void object(const char* key, Presence presence, Describe describe) {
    if (presence == unwritten) return;
    Writer out;
    describe(out);
    json_[key] = std::move(out.json_);
  }
  template <class T>
  void inlined(const std::optional<T>& member) {
    if (member) fields(*this, *member);
  }

 private:
  template <class T>
  static bool is_set(const T& value) {
    if constexpr (requires { value.empty(); })
      return !value.empty();
    else if constexpr (requires { value != T(); })
      return value != T();
    else
      return true;
  }
  template <class T>
  static bool is_set(const std::optional<T>& value) {
    return value.has_value();
  }

  static Json json(const std::string& value) { return value; }
  static Json json(const Rgba& value) { return to_hex(value); }
  static Json json(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }
  static Json json(const Pose& p) { return pose_json(p, canonical_sign(p.q)); }
  static Json json(const Aabb& box) { return box.empty() ? Json() : Json::array({json(box.lo), json(box.hi)}); }
  static Json json(const std::tuple<const std::string&, const std::string&>& pair) {
    return Json::array({std::get<0>(pair), std::get<1>(pair)});
  }
  static Json json(const ParamValue& value) {
    return std::visit(
        [&](const auto& v) {
          if constexpr (std::is_constructible_v<Json, decltype(v)>)
            return Json(v);
          else
            return Json(to_text(value));  // a choice of plugins
        },
        value);
  }
  template <class T>
  static Json json(const std::optional<T>& value) {
    return json(*value);
  }
  template <class T>
  static Json json(const std::vector<T>& values) {
    Json out = Json::array();
    for (const T& value : values) out.push_back(json(value));
    return out;
  }
  template <class T>
  static Json json(const std::map<std::string, T>& values) {
    Json out = Json::object();
    for (const auto& [key, value] : values) out[key] = json(value);
    return out;
  }

  Json json_ = Json::object();
};

/// What screws fasten, by their names: {"clamps", "into", "only"}, as the notes of `tool_access` say it. Notes of
/// another form are no such notes.
std::map<std::string, Json> fastened_in(const Plan& plan) {
  std::map<std::string, Json> out;
  std::set<std::string> names;
  for (const PlanPart& part : plan.assembly.parts) names.insert(part.name);
  const auto known = [&](const Json& parts) {
    return parts.is_array() && std::all_of(parts.begin(), parts.end(), [&](const Json& name) {
             return name.is_string() && names.contains(name.get<std::string>());
           });
  };
  for (const PlanStep& step : plan.disassembly)
    for (const PlanVerdict& verdict : step.checks)
      for (const StepNote& note : verdict.notes) {
        if (!note.kind.starts_with("tool_access.")) continue;
        const Json data = Json::parse(note.data, nullptr, false);
        if (!data.is_object() || !data.contains("fastens") || !data["fastens"].is_object()) continue;
        const Json& said = data["fastens"];
        if (!said.contains("screw") || !said["screw"].is_string()) continue;
        Json fastens = Json::object();
        for (const char* key : {"clamps", "into", "only"})
          if (said.contains(key) && known(said[key])) fastens[key] = said[key];
        if (!fastens.empty()) out[said["screw"]] = std::move(fastens);
      }
  return out;
}

}  // namespace

Json Motion::write(const std::vector<Pose>& poses) {
  Json out = Json::array();
  Eigen::Vector4d before = Eigen::Vector4d::Zero();
  for (const Pose& p : poses) {
    double sign = canonical_sign(p.q);
    if (!out.empty() && before.dot(p.q.coeffs()) != 0) sign = before.dot(p.q.coeffs()) < 0 ? -1 : 1;
    before = sign * p.q.coeffs();
    out.push_back(pose_json(p, sign));
  }
  return out;
}

}  // namespace plan_json

std::string_view to_string(PlanStatus status) {
  return std::array<std::string_view, 3>{"complete", "forced", "partial"}.at(static_cast<std::size_t>(status));
}

std::string_view to_string(AssemblyStatus status) {
  return std::array<std::string_view, 3>{"complete", "partial", "reversed"}.at(static_cast<std::size_t>(status));
}

nlohmann::ordered_json verdicts_json(const std::vector<PlanVerdict>& checks) {
  auto out = nlohmann::ordered_json::array();
  for (const PlanVerdict& verdict : checks) out.push_back(plan_json::Writer::json(verdict));
  return out;
}

std::string to_json(const Plan& plan) {
  auto json = plan_json::Writer::json(plan);
  const auto fastened = plan_json::fastened_in(plan);
  for (auto& part : json["assembly"]["parts"])
    if (const auto said = fastened.find(part["name"]); said != fastened.end()) part["fastens"] = said->second;
  return json_text(json) + "\n";
}

}  // namespace dismantle

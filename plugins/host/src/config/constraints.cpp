#include "config/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "config/layers.h"
#include "dismantle/host/config_bind.h"
#include "dismantle/host/suggest.h"
#include "dismantle/preparation/declared_overlaps.h"

namespace dismantle {
namespace {

std::optional<double> number_of(const ConfigNode& node) {
  if (!node.is_scalar()) return std::nullopt;
  double value = 0;
  const char* end = node.scalar.data() + node.scalar.size();
  const auto [rest, error] = std::from_chars(node.scalar.data(), end, value);
  if (error != std::errc{} || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool is_name(const ConfigNode& node) { return node.is_scalar() && !node.scalar.empty(); }

/// Reads the section and records the place of each name.
class Reader {
 public:
  Reader(std::vector<ConstraintName>& places, std::vector<Diagnostic>& problems)
      : places_(places), problems_(problems) {}

  /// A list of at least `least` names.
  std::vector<std::string> names(const std::string& key, const ConfigNode& list, std::size_t least) {
    std::vector<std::string> out;
    const bool good = list.kind == ConfigNode::Kind::sequence && list.items.size() >= least &&
                      std::all_of(list.items.begin(), list.items.end(), is_name);
    if (!good) {
      problems_.push_back(list.mark.error(
          fmt::format("constraints.{} must be a list of {} names of parts", key, least == 2 ? "two or more" : "")));
      return out;
    }
    for (const auto& item : list.items) out.push_back(name(key, item));
    return out;
  }

  /// A list of lists of two names or more.
  std::vector<std::vector<std::string>> lists(const std::string& key, const ConfigNode& list) {
    std::vector<std::vector<std::string>> out;
    if (list.kind != ConfigNode::Kind::sequence) {
      problems_.push_back(list.mark.error(
          fmt::format("constraints.{} must be a list of lists of names of parts, not {}", key, list.kind_name())));
      return out;
    }
    for (const auto& item : list.items) out.push_back(names(key, item, 2));
    return out;
  }

  /// A list of {parts: [a, b], depth: d}.
  std::vector<NamedOverlap> overlaps(const std::string& key, const ConfigNode& list) {
    std::vector<NamedOverlap> out;
    const std::string expected = fmt::format("constraints.{} must be a list of {{parts: [A, B], depth: D}}", key);
    if (list.kind != ConfigNode::Kind::sequence) {
      problems_.push_back(list.mark.error(fmt::format("{}, not {}", expected, list.kind_name())));
      return out;
    }
    for (const ConfigNode& item : list.items) {
      const ConfigNode *parts = nullptr, *depth = nullptr;
      bool known = item.is_map();
      if (known)
        for (const auto& [name, mark, value] : item.members) {
          if (name == "parts") parts = &value;
          if (name == "depth") depth = &value;
          known = known && (name == "parts" || name == "depth");
        }
      const std::optional<double> number = depth == nullptr ? std::nullopt : number_of(*depth);
      if (!known || parts == nullptr || !number || *number < 0) {
        problems_.push_back(item.mark.error(expected + " with a depth of 0 or more, in input units"));
        continue;
      }
      const std::vector<std::string> pair = names(key, *parts, 2);
      if (pair.size() == 2 && pair[0] != pair[1])
        out.push_back({pair[0], pair[1], *number});
      else if (!pair.empty())
        problems_.push_back(item.mark.error(expected + ": two different parts"));
    }
    return out;
  }

  /// A list of {part: A, against: B, as: WORD, depth: D}.
  std::vector<NamedAcceptance> acceptances(const std::string& key, const ConfigNode& list) {
    std::vector<NamedAcceptance> out;
    const std::string expected =
        fmt::format("constraints.{} must be a list of {{part: A, against: B, as: snap, depth: D}}", key);
    if (list.kind != ConfigNode::Kind::sequence) {
      problems_.push_back(list.mark.error(fmt::format("{}, not {}", expected, list.kind_name())));
      return out;
    }
    for (const ConfigNode& item : list.items) {
      std::map<std::string, const ConfigNode*> values{{"part", nullptr}, {"against", nullptr}, {"as", nullptr}, {"depth", nullptr}};
      bool good = item.is_map();
      if (good)
        for (const auto& [name, mark, value] : item.members) {
          const auto known = values.find(name);
          good = good && known != values.end() && known->second == nullptr && is_name(value);
          if (known != values.end()) known->second = &value;
        }
      for (const auto& [name, value] : values) good = good && value != nullptr;
      const std::optional<double> depth = good ? number_of(*values["depth"]) : std::nullopt;
      if (!depth || *depth <= 0) {
        problems_.push_back(item.mark.error(expected + " with a depth above 0, in input units"));
        continue;
      }
      out.push_back({name(key, *values["part"]), name(key, *values["against"]), values["as"]->scalar, *depth});
      if (out.back().part == out.back().against)
        problems_.push_back(item.mark.error(expected + ": two different parts"));
    }
    return out;
  }

  std::string name(const std::string& key, const ConfigNode& node) {
    places_.push_back({key, node.scalar, node.mark.error("")});
    return node.scalar;
  }

 private:
  std::vector<ConstraintName>& places_;
  std::vector<Diagnostic>& problems_;
};

/// Finds constraints that contradict each other, independent of the input.
class Contradictions {
 public:
  Contradictions(const NamedConstraints& asked, const std::vector<ConstraintName>& places,
                 std::vector<Diagnostic>& problems)
      : asked_(asked), places_(places), problems_(problems) {}

  void report() {
    report_cycle();
    report_base();
    report_ignored();
  }

 private:
  void problem(const std::string& key, const std::string& name, const std::string& message) {
    for (const auto& place : places_) {
      if (place.key != key || place.name != name) continue;
      Diagnostic out = place.place;
      out.message = message;
      problems_.push_back(std::move(out));
      return;
    }
  }

  /// Reports a problem at the place where the two names follow each other.
  void link_problem(const std::pair<std::string, std::string>& link, const std::string& message) {
    for (std::size_t i = 0; i + 1 < places_.size(); ++i) {
      if (places_[i].key != "before" || places_[i].name != link.first || places_[i + 1].name != link.second) continue;
      Diagnostic out = places_[i].place;
      out.message = message;
      problems_.push_back(std::move(out));
      return;
    }
  }

  /// The first name of the group of `name`: parts of `together` leave as one.
  std::string group_of(const std::string& name) const {
    std::set<std::string> reached{name};
    for (bool grown = true; grown;) {
      grown = false;
      for (const auto& list : asked_.together)
        if (std::ranges::any_of(list, [&](const std::string& n) { return reached.contains(n); }))
          for (const auto& n : list) grown = reached.insert(n).second || grown;
    }
    return *reached.begin();
  }

  /// Reports the first cycle found: a part that must leave before itself.
  void report_cycle() {
    std::map<std::string, std::vector<std::pair<std::string, std::string>>> later;  // group -> (names of the link)
    for (const auto& list : asked_.before)
      for (std::size_t k = 1; k < list.size(); ++k) {
        const bool together = group_of(list[k - 1]) == group_of(list[k]);
        if (together && list[k - 1] != list[k]) continue;  // they leave at the same time
        later[group_of(list[k - 1])].emplace_back(list[k - 1], list[k]);
      }
    std::set<std::string> done;
    for (const auto& [start, links] : later) {
      std::vector<std::pair<std::string, std::string>> chain;
      if (follow(start, later, chain, done)) return;
    }
  }

  bool follow(const std::string& group,
              const std::map<std::string, std::vector<std::pair<std::string, std::string>>>& later,
              std::vector<std::pair<std::string, std::string>>& chain, std::set<std::string>& done) {
    const auto at = std::ranges::find_if(chain, [&](const auto& link) { return group_of(link.first) == group; });
    if (at != chain.end()) {
      std::string text = fmt::format("'{}'", at->first);
      for (auto link = at; link != chain.end(); ++link) text += fmt::format(" before '{}'", link->second);
      link_problem(chain.back(), "constraints.before contradicts itself: " + text);
      return true;
    }
    if (done.contains(group)) return false;
    if (const auto links = later.find(group); links != later.end())
      for (const auto& link : links->second) {
        chain.push_back(link);
        if (follow(group_of(link.second), later, chain, done)) return true;
        chain.pop_back();
      }
    done.insert(group);
    return false;
  }

  /// Base parts never move, so they cannot leave.
  void report_base() {
    const auto in_base = [&](const std::string& name) { return std::ranges::count(asked_.base, name) > 0; };
    for (const auto& list : asked_.before)
      for (std::size_t k = 0; k < list.size(); ++k)
        if (in_base(list[k]) && k + 1 < list.size())
          problem(
              "before", list[k],
              fmt::format("constraints.before wants '{}' to leave, and constraints.base wants it to stay", list[k]));
    if (in_base(asked_.target))
      problem("target", asked_.target,
              fmt::format("constraints.target is '{}', and constraints.base wants it to stay", asked_.target));
  }

  void report_ignored() {
    for (const auto& place : places_)
      if (place.key != "ignore" && std::ranges::count(asked_.ignore, place.name) > 0) {
        Diagnostic out = place.place;
        out.message =
            fmt::format("constraints.{} names '{}', which constraints.ignore leaves out", place.key, place.name);
        problems_.push_back(std::move(out));
      }
  }

  const NamedConstraints& asked_;
  const std::vector<ConstraintName>& places_;
  std::vector<Diagnostic>& problems_;
};

}  // namespace

const std::vector<std::string>& constraint_keys() {
  static const std::vector<std::string> keys{"base", "together", "before", "target", "ignore", "flexible", "overlap", "accept"};
  return keys;
}

NamedConstraints read_constraints(const ConfigNode& section, std::vector<ConstraintName>& places,
                                  std::vector<Diagnostic>& problems) {
  NamedConstraints out;
  if (!section.is_map()) {
    problems.push_back(
        section.mark.error(fmt::format("constraints must be a map of keys, not {}", section.kind_name())));
    return out;
  }
  const std::size_t before = problems.size();
  Reader reader(places, problems);
  for (const auto& [key, key_mark, value] : section.members) {
    if (key == "base") {
      out.base = reader.names(key, value, 0);
    } else if (key == "ignore") {
      out.ignore = reader.names(key, value, 0);
    } else if (key == "flexible") {
      out.flexible = reader.names(key, value, 0);
    } else if (key == "overlap") {
      out.overlap = reader.overlaps(key, value);
    } else if (key == "accept") {
      out.accept = reader.acceptances(key, value);
    } else if (key == "together") {
      out.together = reader.lists(key, value);
    } else if (key == "before") {
      out.before = reader.lists(key, value);
    } else if (key == "target") {
      if (is_name(value))
        out.target = reader.name(key, value);
      else
        problems.push_back(value.mark.error("constraints.target must be the name of a part"));
    } else {
      problems.push_back(
          key_mark.error(unknown_key_message(key, {"constraints", "", ""}, constraint_keys(), KeyHomes{})));
    }
  }
  if (problems.size() == before) Contradictions(out, places, problems).report();
  return out;
}

void check_constraint_names(const RunConfig& config, const std::vector<std::string>& parts, const std::string& input) {
  std::vector<Diagnostic> problems;
  for (const auto& [key, name, place] : config.constraint_names) {
    if (std::ranges::count(parts, name) > 0) continue;
    problems.push_back(place);
    problems.back().message = fmt::format("constraints.{}: {} has no part '{}'", key, input, name);
    if (const auto near = nearest(name, parts))
      problems.back().message += fmt::format("; did you mean '{}'?", *near);
    else if (parts.size() <= 20)
      problems.back().message += fmt::format("; its parts: '{}'", fmt::join(parts, "', '"));
  }
  if (problems.empty()) return;
  sort_by_place(problems);
  throw ConfigError(std::move(problems));
}

void declare_overlaps(const NamedConstraints& named, Assembly& assembly) {
  for (const std::string& part : named.flexible) declare_flexible(assembly, part);
  for (const NamedOverlap& o : named.overlap)
    declare_overlap(assembly, o.a, o.b, o.depth * assembly.normalization.scale);
}

Constraints constraints_of(const NamedConstraints& named, const Assembly& assembly) {
  std::vector<std::string> missing;
  const auto id = [&](const std::string& name) -> PartId {
    for (const auto& part : assembly.parts)
      if (part.name == name) return part.id;
    std::string text = fmt::format("'{}'", name);
    for (const auto& part : assembly.excluded)
      if (part.name == name) text += fmt::format(" (left out: {})", part.reason);
    if (std::ranges::count(missing, text) == 0) missing.push_back(std::move(text));
    return 0;
  };
  const auto ids = [&](const std::vector<std::string>& list) {
    std::vector<PartId> out;
    for (const auto& name : list) out.push_back(id(name));
    return out;
  };
  Constraints out;
  out.base = ids(named.base);
  for (const auto& list : named.together) out.together.push_back(ids(list));
  for (const auto& list : named.before)
    for (std::size_t k = 1; k < list.size(); ++k) out.before.emplace_back(id(list[k - 1]), id(list[k]));
  for (const NamedAcceptance& a : named.accept)
    out.accept.push_back({id(a.part), id(a.against), a.as, a.depth * assembly.normalization.scale});
  if (!named.target.empty()) out.target = id(named.target);
  if (!missing.empty())
    throw InputError(assembly.source,
                     fmt::format("constraints name parts that are not there: {}", fmt::join(missing, ", ")));
  return out;
}

}  // namespace dismantle

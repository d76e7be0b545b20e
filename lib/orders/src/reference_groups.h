/// Which sub-models a step of a reference order puts in whole.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace dismantle {

/// What a step puts in.
template <class Part>
struct StepItems {
  std::vector<Part> parts;          ///< by themselves
  std::vector<std::string> groups;  ///< built before, put in whole
};

/// Step: ReferenceStep or PlanReferenceStep.
template <class Step>
class ReferenceGroups {
 public:
  using Part = typename decltype(Step::parts)::value_type;

  explicit ReferenceGroups(const std::vector<Step>& order) {
    for (const Step& step : order) parts_[step.group].insert(step.parts.begin(), step.parts.end());
  }

  const std::set<Part>& parts_of(const std::string& group) const { return parts_.at(group); }

  /// `around`: the groups that are being built, which are no items of their own steps. The largest groups first.
  StepItems<Part> items_of(const Step& step, const std::set<std::string>& around) const {
    std::set<Part> left(step.parts.begin(), step.parts.end());
    std::vector<std::string> inner;
    const auto whole = [&](const std::set<Part>& parts) {
      return std::includes(left.begin(), left.end(), parts.begin(), parts.end());
    };
    for (const auto& [name, parts] : parts_)
      if (!around.contains(name) && whole(parts)) inner.push_back(name);
    std::stable_sort(inner.begin(), inner.end(), [&](const std::string& a, const std::string& b) {
      return parts_.at(a).size() > parts_.at(b).size();
    });
    StepItems<Part> out;
    for (const std::string& name : inner) {
      const std::set<Part>& parts = parts_.at(name);
      if (!whole(parts)) continue;  // it is in a larger one
      for (const Part& part : parts) left.erase(part);
      out.groups.push_back(name);
    }
    out.parts.assign(left.begin(), left.end());
    return out;
  }

 private:
  std::map<std::string, std::set<Part>> parts_;
};

}  // namespace dismantle

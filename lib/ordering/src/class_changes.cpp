#include "dismantle/ordering/class_changes.h"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <vector>

namespace dismantle::order {

namespace {

class ClassRows {
 public:
  ClassRows(Problem& problem, const Task& task, const std::function<std::size_t(VariantId)>& class_of, Effort& effort)
      : problem_(problem), stay_(task.end == End::exactly ? task.goal : UnitSet(problem.units())), effort_(effort) {
    one_stays_ = task.end == End::one_left;
    std::map<std::size_t, std::vector<VariantId>> by_class;
    for (std::size_t u = 0; u < problem.units(); ++u)
      for (const VariantId v : problem.variants_of(u))
        if (!problem.leaving(v).intersects(stay_)) by_class[class_of(v)].push_back(v);
    for (auto& [key, variants] : by_class) classes_.push_back(std::move(variants));
  }

  /// The least number of classes in a row that take all out of the set.
  std::size_t least(const UnitSet& left) {
    std::size_t length = 0;
    while (length < classes_.size() * problem_.units() && !suffice(left, length)) ++length;
    return length;
  }

 private:
  bool is_done(const UnitSet& left) const { return one_stays_ ? left.size() <= 1 : (left - stay_).empty(); }

  /// Also true if that is not known for lack of effort.
  bool suffice(const UnitSet& left, std::size_t length) {
    if (is_done(left)) return true;
    if (length == 0) return false;
    const auto known = refuted_.find(left);
    if (known != refuted_.end() && known->second >= length) return false;
    for (const std::vector<VariantId>& variants : classes_) {
      if (effort_.left == 0) return true;
      const UnitSet rest = taken_out(left, variants);
      if (!(rest == left) && suffice(rest, length - 1)) return true;
    }
    refuted_[left] = length;
    return false;
  }

  /// Empty if the effort does not suffice. What is left when the variants have taken out all that they can. A variant
  /// of several units needs only one of them to be there: this can only make the row shorter.
  UnitSet taken_out(UnitSet left, const std::vector<VariantId>& variants) {
    for (bool more = true; more && !is_done(left);) {
      more = false;
      if (!effort_.spend(variants.size())) return {};
      for (const VariantId v : variants) {
        const UnitSet& units = problem_.leaving(v);
        if (!units.intersects(left)) continue;
        UnitSet present = left;
        present |= units;
        if (!problem_.may_leave(v, present)) continue;
        left -= units;
        more = true;
      }
    }
    return left;
  }

  Problem& problem_;
  UnitSet stay_;
  bool one_stays_ = false;
  Effort& effort_;
  std::vector<std::vector<VariantId>> classes_;
  std::unordered_map<UnitSet, std::size_t, UnitSetHash> refuted_;  ///< so many classes in a row do not suffice
};

}  // namespace

std::size_t least_class_changes(Problem& problem, const Task& task,
                                const std::function<std::size_t(VariantId)>& class_of, Effort& effort) {
  const std::size_t classes = ClassRows(problem, task, class_of, effort).least(task.start);
  return classes > 0 ? classes - 1 : 0;
}

}  // namespace dismantle::order

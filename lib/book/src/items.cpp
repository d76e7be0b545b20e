#include "items.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "dismantle/plan_io/job_list.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/text_columns.h"

namespace dismantle {
namespace {

/// "bolt_M10" for "bolt_M10_1", "bolt_M10_12": without a number that was cut, and what joins it. The first name when
/// the common beginning is too short.
std::string common_name(const std::vector<std::string>& names) {
  std::string stem = names.front();
  for (const std::string& name : names)
    stem.resize(static_cast<std::size_t>(std::ranges::mismatch(stem, name).in1 - stem.begin()));
  if (names.size() == 1) return stem;
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const bool cut = std::ranges::any_of(
      names, [&](const std::string& name) { return name.size() > stem.size() && digit(name[stem.size()]); });
  while (cut && !stem.empty() && digit(stem.back())) stem.pop_back();
  while (!stem.empty() && std::string_view(" _-.#:(").find(stem.back()) != std::string_view::npos) stem.pop_back();
  while (!stem.empty() && (static_cast<unsigned char>(stem.back()) & 0x80) != 0) stem.pop_back();  // cut character
  return stem.size() >= 3 ? stem : names.front();
}

class ItemFinder {
 public:
  ItemFinder(BookContent& content, const Plan& plan, const Assembly& assembly, const TextUnit& unit)
      : content_(content), plan_(plan), assembly_(assembly), unit_(unit) {}

  ItemNumbers find(const std::vector<std::size_t>& firsts) {
    numbers_.of_part.resize(assembly_.parts.size());
    std::vector<bool> listed_here = handled();
    std::vector<std::string> rest;
    for (std::size_t i = 0; i < assembly_.parts.size(); ++i)
      if (!listed_here[i]) rest.push_back(assembly_.parts[i].name);
    if (!rest.empty())
      content_.base = fmt::format("{} that stay together are not listed: {}", text::counted(rest.size(), "part"),
                                  listed_names(rest));
    find_products(listed_here);
    std::map<std::size_t, std::size_t> item_of_shape;
    for (std::size_t i = 0; i < assembly_.parts.size(); ++i) {
      if (!listed_here[i]) continue;
      const auto [it, fresh] = item_of_shape.try_emplace(firsts[i], content_.items.size());
      if (fresh) {
        add_item({{i, Pose{}}});
        content_.items.back().size = kind_words(assembly_.parts[i].name, ", ") + content_.items.back().size;
      }
      BookItem& item = content_.items[it->second];
      item.names.push_back(assembly_.parts[i].name);
      numbers_.of_part[i] = it->second;
    }
    for (BookItem& item : content_.items)
      if (item.name.empty()) item.name = common_name(item.names);
    label_items();
    content_.numbers.assign(assembly_.parts.size(), 0);
    for (const BookItem& item : content_.items)
      for (const PlacedPart& placed : item.picture) content_.numbers[placed.part] = item.number;
    for (std::size_t i = 0; i < assembly_.parts.size(); ++i)
      if (numbers_.of_part[i]) content_.numbers[i] = content_.items[*numbers_.of_part[i]].number;
    return std::move(numbers_);
  }

 private:
  /// By part: does the book put it in, take it out, or begin with it alone? Others stay together with their neighbours.
  std::vector<bool> handled() const {
    std::vector<bool> out(assembly_.parts.size());
    for (const BookChapter& chapter : content_.chapters) {
      for (const BookStep& step : chapter.steps)
        if (!step.shifts_only)
          for (const BookMover& mover : step.movers)
            for (const std::size_t i : mover.parts) out[i] = true;
      std::vector<std::string> base;
      for (const std::size_t i : chapter.base) base.push_back(assembly_.parts[i].name);
      const std::size_t products = text::take_components(plan_.assembly, base).size();
      if (products + base.size() == 1)
        for (const std::size_t i : chapter.base) out[i] = true;
    }
    return out;
  }

  /// Products whose bodies the file keeps together; takes their bodies out of `parts`.
  void find_products(std::vector<bool>& parts) {
    std::map<std::string, std::size_t> index, item_of_product;
    for (std::size_t i = 0; i < assembly_.parts.size(); ++i) index.emplace(assembly_.parts[i].name, i);
    for (const PlanComponent& component : plan_.assembly.components) {
      std::vector<PlacedPart> bodies;
      for (const std::string& name : component.parts)
        if (const auto known = index.find(name); known != index.end() && parts[known->second])
          bodies.push_back({known->second, Pose{}});
      if (!component.kept || bodies.size() != component.parts.size()) continue;
      for (const PlacedPart& body : bodies) parts[body.part] = false;
      const auto [it, fresh] = item_of_product.try_emplace(component.product, content_.items.size());
      if (fresh) {
        add_item(std::move(bodies));
        content_.items.back().name = component.product;
      }
      content_.items[it->second].names.push_back(component.name);
      numbers_.of_component.emplace(component.name, it->second);
    }
  }

  /// "screw M5x20" and `end`; empty for what is not recognised.
  std::string kind_words(const std::string& name, const char* end) const {
    for (const PlanPart& part : plan_.assembly.parts)
      if (part.name == name && part.kind && part.kind->kind != "other")
        return part.kind->kind + (part.kind->size.empty() ? "" : " " + part.kind->size) + end;
    return {};
  }

  /// Fasteners are called by their size, too. A name that different items share tells nothing.
  void label_items() {
    std::map<std::string, std::string> sizes;  // by part
    for (const JobFastener& fastener : job_list(plan_).fasteners)
      for (const std::string& part : fastener.parts) sizes[part] = fastener.size;
    std::map<std::string, std::size_t> uses;
    for (const BookItem& item : content_.items) ++uses[item.name];
    for (BookItem& item : content_.items) {
      const std::string& first = item.names.front();
      item.label = item.name;
      if (uses[item.name] > 1) {
        const std::string kind = kind_words(first, "");
        item.label = kind.empty() ? first : kind;
      } else if (const auto size = sizes.find(first); size != sizes.end() && !size->second.empty()) {
        if (item.name.find(size->second) == std::string::npos) item.label += " (" + size->second + ")";
      }
    }
  }

  void add_item(std::vector<PlacedPart> picture) {
    Aabb box;
    for (const PlacedPart& placed : picture) box.extend(assembly_.parts[placed.part].mesh->box());
    content_.items.push_back({content_.items.size() + 1,
                              {},
                              {},
                              {},
                              std::move(picture),
                              size_text(box.size() / assembly_.normalization.scale, unit_)});
  }

  BookContent& content_;
  const Plan& plan_;
  const Assembly& assembly_;
  const TextUnit& unit_;
  ItemNumbers numbers_;
};

}  // namespace

ItemNumbers find_items(BookContent& content, const Plan& plan, const Assembly& assembly,
                       const std::vector<std::size_t>& items, const TextUnit& unit) {
  return ItemFinder(content, plan, assembly, unit).find(items);
}

std::string listed_names(std::vector<std::string> names) {
  const std::size_t most = 8;  // largest number of names in a sentence
  if (names.size() <= most) return text::joined(names);
  const std::size_t more = names.size() - most + 1;
  names.resize(most - 1);
  return fmt::format("{} and {} more", text::joined(names), more);
}

std::string size_text(Eigen::Vector3d box, const TextUnit& unit) {
  box *= unit.factor;
  return fmt::format("{} × {} × {} {}", figure_text(box.x()), figure_text(box.y()), figure_text(box.z()), unit.name);
}

}  // namespace dismantle

#include "content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "content_basis.h"
#include "dismantle/errors.h"
#include "dismantle/plan_io/bill_items.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/plan_io/thread_words.h"
#include "dismantle/plan_io/travel.h"
#include "equal_steps.h"
#include "front_matter.h"
#include "items.h"

namespace dismantle {
namespace {

using BookJson = nlohmann::json;

/// Parts that a note says must be held: {"hold": [{"part": NAME}]}.
std::vector<std::string> held_by(const StepNote& note) {
  std::vector<std::string> out;
  const BookJson data = BookJson::parse(note.data, nullptr, false);
  if (!data.is_object() || !data.contains("hold") || !data["hold"].is_array()) return out;
  for (const BookJson& held : data["hold"])
    if (held.is_object() && held.contains("part") && held["part"].is_string()) out.push_back(held["part"]);
  return out;
}

class ContentWriter : private ContentBasis {
 public:
  ContentWriter(const Plan& plan_of_book, const Assembly& parts, const BookOptions& how,
                const std::vector<geometry::ShapePlacement>& shapes)
      : ContentBasis{plan_of_book,
                     parts,
                     how,
                     how.frame,
                     text_unit(how.frame, parts.input_box),
                     BookWords(how.language, how.phrases)},
        size_(parts.input_box.empty() ? 1 : parts.input_box.size().maxCoeff()) {
    content_.chapters = instructions(plan, assembly, options.disassembly);
    if (content_.chapters.empty())
      throw InputError(plan.assembly.source, "the plan has no steps, so there is nothing to instruct");
    const std::vector<std::size_t> items = bill_items(plan.assembly, assembly, shapes);
    join_equal_steps(content_.chapters, plan, assembly, items);
    numbers_ = find_items(content_, plan, assembly, items, unit);
  }

  BookContent write() {
    for (const BookChapter& chapter : content_.chapters)
      for (std::size_t s = 0; s < chapter.steps.size(); ++s) add_page(chapter, s);
    std::ranges::sort(content_.pages, {}, &BookPage::number);
    write_front_matter(content_, *this);
    return std::move(content_);
  }

 private:
  static std::vector<PlacedPart> placed(const std::vector<std::size_t>& parts) {
    std::vector<PlacedPart> out;
    for (const std::size_t i : parts) out.push_back({i, Pose{}});
    return out;
  }

  void add_to_box(BookPage& page, std::size_t item, std::size_t count) const {
    const std::size_t number = content_.items[item].number;
    const auto same = std::ranges::find(page.box, number, &BoxEntry::item);
    if (same != page.box.end())
      same->count += count;
    else
      page.box.push_back({number, count, content_.items[item].picture});
  }

  static bool moves(const BookStep& step, std::size_t part) {
    return std::ranges::any_of(step.movers,
                               [&](const BookMover& m) { return std::ranges::find(m.parts, part) != m.parts.end(); });
  }

  /// The notes of the reader of the plan on what one step moves. `who` precedes them.
  void add_own_notes(const std::vector<std::size_t>& moving, const std::string& who, BookPage& page) const {
    std::vector<std::string> moved;
    for (const std::size_t i : moving) moved.push_back(assembly.parts[i].name);
    std::ranges::sort(moved);
    for (const BookNote& note : options.notes) {
      std::vector<std::string> parts = note.parts;
      std::ranges::sort(parts);
      if (parts == moved) page.own_notes.push_back(who + note.text);
    }
  }

  std::string chapter_name(const BookChapter& chapter) const {
    if (chapter.letter < 0) return words.label(content_.chapters.size() > 1 ? "The whole assembly" : "Assembly");
    std::string letters;  // A..Z, AA..
    for (int n = chapter.letter; n >= 0; n = n / 26 - 1)
      letters.insert(letters.begin(), static_cast<char>('A' + n % 26));
    return said("Sub-assembly {}", letters);
  }

  std::string names_of(const std::vector<std::size_t>& parts) const {
    std::vector<std::string> names;
    for (const std::size_t i : parts) names.push_back(assembly.parts[i].name);
    return listed_names(std::move(names));
  }

  /// The chapter of the sub-assembly that consists of these parts, or null.
  const BookChapter* chapter_of(const std::vector<std::size_t>& parts) const {
    for (const BookChapter& chapter : content_.chapters)
      if (chapter.letter >= 0 && chapter.parts == parts) return &chapter;
    return nullptr;
  }

  void add_page(const BookChapter& chapter, std::size_t index) {
    const BookStep& step = chapter.steps[index];
    BookPage page;
    page.step = &step;
    page.chapter = chapter_name(chapter);
    page.chapter_begins = index == 0;
    page.number = step.number;
    page.last = step.number + step.joined.size();
    page.count = plan.disassembly.size();
    page.verb = words.label(step.shifts_only      ? (options.disassembly ? "Move aside" : "Move back")
                            : options.disassembly ? "Take out"
                                                  : "Put in");
    std::vector<std::string> instances;
    if (step.joined.empty()) {
      for (const BookMover& mover : step.movers) add_moving(mover.parts, page, instances);
    } else {
      std::vector<std::size_t> all;
      for (const BookMover& mover : step.movers) all.insert(all.end(), mover.parts.begin(), mover.parts.end());
      add_moving(all, page, instances);
    }
    const std::size_t told = step.joined.empty() ? step.movers.size() : 1;  // equal steps move alike
    for (std::size_t m = 0; m < told; ++m) add_motion(step, step.movers[m], page);
    if (step.movers.empty()) page.motions.push_back(words.label("it is apart already: nothing has to move"));
    if (step.up) fact(page.facts, "lies", words.text(lie_words(*step.up, frame.up)));
    if (index == 0 && !options.disassembly) fact(page.facts, "base", names_of(chapter.base));
    if (index == 0 && options.disassembly && chapter.letter >= 0) fact(page.facts, "of", names_of(chapter.parts));
    add_notes_of_the_reader(step, page);
    if (!instances.empty()) fact(page.facts, "instance", listed_names(instances));
    add_plan_facts(page);
    content_.pages.push_back(std::move(page));
  }

  void add_notes_of_the_reader(const BookStep& step, BookPage& page) const {
    std::vector<std::size_t> all;
    for (const BookMover& mover : step.movers) {
      all.insert(all.end(), mover.parts.begin(), mover.parts.end());
      if (!step.joined.empty()) add_own_notes(mover.parts, names_of(mover.parts) + ": ", page);
    }
    add_own_notes(all, "", page);
  }

  /// What is put in or taken out together, by items.
  void add_moving(const std::vector<std::size_t>& parts, BookPage& page, std::vector<std::string>& instances) const {
    if (const BookChapter* built = chapter_of(parts)) {
      page.box.push_back({0, 1, placed(parts)});
      page.moving.emplace_back(0, said("{} ({} parts)", chapter_name(*built), built->parts.size()));
      return;
    }
    std::vector<std::string> singles;
    for (const std::size_t i : parts) singles.push_back(assembly.parts[i].name);
    std::map<std::size_t, std::vector<std::string>> of_item;
    std::vector<std::string> others;
    std::vector<std::pair<std::size_t, std::string>> products;  // item, name
    for (const PlanComponent* c : text::take_components(plan.assembly, singles)) {
      const auto item = numbers_.of_component.find(c->name);
      if (item == numbers_.of_component.end())
        page.moving.emplace_back(0, c->name);
      else
        products.emplace_back(item->second, c->name);
    }
    for (const auto& [item, name] : products) {
      const bool several = std::ranges::count(products, item, &std::pair<std::size_t, std::string>::first) > 1;
      add_to_box(page, item, 1);
      if (several)
        of_item[item].push_back(name);
      else
        page.moving.emplace_back(content_.items[item].number, name);
    }
    for (const std::size_t i : parts) {
      const std::string& name = assembly.parts[i].name;
      if (std::ranges::find(singles, name) == singles.end()) continue;
      if (numbers_.of_part[i]) {
        of_item[*numbers_.of_part[i]].push_back(name);
        add_to_box(page, *numbers_.of_part[i], 1);
      } else {
        others.push_back(name);
      }
    }
    for (const std::string& name : others) page.moving.emplace_back(0, name);
    for (const auto& [item, names] : of_item) {
      const BookItem& what = content_.items[item];
      page.moving.emplace_back(what.number,
                               names.size() == 1 ? what.label : fmt::format("{} × {}", names.size(), what.label));
      for (const std::string& name : names)
        if (name != what.label) instances.push_back(name);
    }
  }

  /// A line of the motion, and its vectors.
  void add_motion(const BookStep& step, const BookMover& mover, BookPage& page) const {
    const MotionSummary motion = summarize_motion(mover.poses, mover.center, stretch_tolerance(size_));
    const std::optional<double> guided = guided_distance_of(step, mover, motion);
    const std::string who = step.movers.size() > 1 && step.joined.empty() ? names_of(mover.parts) + ": " : "";
    page.motions.push_back(who + words.text(travel_words(motion, guided, {unit, frame.up, size_, options.disassembly},
                                                         frame.lies(step.up))));
    add_vectors(motion, guided, who, page.facts);
  }

  /// What the plan says about the step, or about all steps of the page.
  void add_plan_facts(BookPage& page) const {
    std::vector<Facts> each{facts_of(page.step->plan_step, page)};
    for (const std::size_t s : page.step->joined) each.push_back(facts_of(s, page));
    std::ranges::sort(page.held);
    const auto [from, to] = std::ranges::unique(page.held);
    page.held.erase(from, to);
    const auto name_of = [&](const std::string& part) {
      for (std::size_t i = 0; i < assembly.parts.size(); ++i)
        if (assembly.parts[i].name == part && numbers_.of_part[i]) return content_.items[*numbers_.of_part[i]].label;
      return part;
    };
    for (auto& fact : facts_of_all(each, words.label("order"), name_of)) page.facts.push_back(std::move(fact));
  }

  /// Of one step; warnings and holds go to the page.
  Facts facts_of(std::size_t plan_step, BookPage& page) const {
    const PlanStep& step = plan.disassembly[plan_step];
    Facts facts;
    if (step.forced && step.forced->accepted.empty()) {
      page.warning = said("Not verified: {}.", words.text(forced_text(unit, *step.forced)));
      Facts why;
      if (const std::string reached = reached_text(plan, unit, step); !reached.empty())
        fact(why, "how far", words.text(reached));
      if (!step.forced->reason.empty()) fact(why, "because", words.text(step.forced->reason));
      if (const std::string advice = forced_advice(*step.forced); !advice.empty()) fact(why, "you can", advice);
      page.facts.insert(page.facts.begin(), why.begin(), why.end());  // before what may not have room
    }
    if (step.forced && !step.forced->accepted.empty())
      facts.emplace_back(step.forced->accepted, forced_text(unit, *step.forced));
    for (const std::string& cut : thread_words(plan, step)) fact(facts, "note", words.text(cut + "."));
    for (const PlanVerdict& v : step.checks)
      for (const StepNote& note : v.notes) {
        const std::vector<std::string> held = held_by(note);
        for (const std::string& name : held)
          for (std::size_t i = 0; i < assembly.parts.size(); ++i)
            if (assembly.parts[i].name == name && !moves(*page.step, i)) page.held.push_back(i);
        const char* kind = !held.empty() ? "hold" : note.kind.starts_with("tool_access") ? "tool" : "note";
        fact(facts, kind, words.text(note.text));
      }
    if (const std::string order = order_words(plan, plan_step, options.disassembly); !order.empty())
      fact(facts, "order", words.text(order));
    if (!step.contacts.empty()) fact(facts, "touches", text::joined(step.contacts));
    return facts;
  }

  /// None for what is not one straight motion by which parts join or leave.
  std::optional<double> guided_distance_of(const BookStep& step, const BookMover& mover,
                                           const MotionSummary& motion) const {
    if (step.shifts_only || (step.movers.size() != 1 && step.joined.empty()) || !is_straight(motion))
      return std::nullopt;
    PosedParts moving, fixed;
    for (const std::size_t i : mover.parts)
      moving.emplace_back(i, options.disassembly ? mover.poses.front() : mover.poses.back());
    for (const PlacedPart& part : step.standing) fixed.emplace_back(part.part, part.pose);
    const Eigen::Vector3d outwards = (options.disassembly ? 1 : -1) * motion.stretches.front();
    return std::min(guided_distance(assembly, moving, fixed, outwards), motion.length);
  }

  void add_vectors(const MotionSummary& motion, std::optional<double> guided, const std::string& who,
                   Facts& facts) const {
    if (motion.length > 0 && motion.displacement.norm() > 1e-6 * size_) {
      const Eigen::Vector3d d = motion.displacement.normalized();
      const auto rounded = [](double x) { return std::round(1000 * x) / 1000 + 0.0; };
      fact(facts, "direction", fmt::format("{}({}, {}, {})", who, rounded(d.x()), rounded(d.y()), rounded(d.z())));
      if (!guided)
        fact(facts, "distance", who + length_of(motion.displacement.norm()));
      else if (const double distance = stated_distance(motion, guided, size_); distance > 0)
        fact(facts, "distance", who + length_of(distance));
    }
    if (motion.length > 1.01 * motion.displacement.norm())
      fact(facts, "length of the path", who + length_of(motion.length));
  }

  const double size_;
  ItemNumbers numbers_;
  BookContent content_;
};

}  // namespace

std::string BookPage::numbers() const {
  return last > number ? fmt::format("{}–{}", number, last) : std::to_string(number);
}

BookContent book_content(const Plan& plan, const Assembly& assembly, const BookOptions& options,
                         const std::vector<geometry::ShapePlacement>& shapes) {
  return ContentWriter(plan, assembly, options, shapes).write();
}

}  // namespace dismantle

#include "content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "dismantle/errors.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/job_list.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/order_words.h"
#include "dismantle/plan_io/plan_account.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/plan_io/thread_words.h"
#include "dismantle/plan_io/travel.h"
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

class ContentWriter {
 public:
  ContentWriter(const Plan& plan, const Assembly& assembly, const BookOptions& options,
                const std::vector<geometry::ShapePlacement>& shapes)
      : plan_(plan),
        assembly_(assembly),
        options_(options),
        frame_(options.frame),
        unit_(text_unit(frame_, assembly.input_box)),
        words_(options.language, options.phrases),
        size_(assembly.input_box.empty() ? 1 : assembly.input_box.size().maxCoeff()) {
    content_.chapters = instructions(plan_, assembly_, options_.disassembly);
    if (content_.chapters.empty())
      throw InputError(plan_.assembly.source, "the plan has no steps, so there is nothing to instruct");
    numbers_ = find_items(content_, plan_, assembly_, shapes, unit_);
  }

  BookContent write() {
    write_title();
    for (const BookChapter& chapter : content_.chapters)
      for (std::size_t s = 0; s < chapter.steps.size(); ++s) add_page(chapter, s);
    std::ranges::sort(content_.pages, {}, &BookPage::number);
    write_contents();
    write_job();
    write_account();
    return std::move(content_);
  }

 private:
  /// A label with its places filled.
  template <class... Args>
  std::string said(const char* english, Args&&... args) const {
    return fmt::format(fmt::runtime(words_.label(english)), args...);
  }

  void fact(Facts& facts, const char* name, std::string value) const {
    facts.emplace_back(words_.label(name), std::move(value));
  }

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

  /// The notes of the reader of the plan on what this step moves.
  void add_own_notes(const BookStep& step, BookPage& page) const {
    std::vector<std::string> moved;
    for (const BookMover& mover : step.movers)
      for (const std::size_t i : mover.parts) moved.push_back(assembly_.parts[i].name);
    std::ranges::sort(moved);
    for (const BookNote& note : options_.notes) {
      std::vector<std::string> parts = note.parts;
      std::ranges::sort(parts);
      if (parts == moved) page.own_notes.push_back(note.text);
    }
  }

  void write_job() {
    const JobList job = job_list(plan_, options_.disassembly);
    if (!job.fasteners.empty()) content_.job.push_back({words_.label("Fasteners"), 0, true});
    for (const JobFastener& f : job.fasteners) content_.job.push_back({fastener_words(f), 0, false});
    if (!job.tools.empty()) content_.job.push_back({words_.label("Tools"), 0, true});
    for (const JobTool& t : job.tools) content_.job.push_back({tool_words(t), 0, false});
  }

  void write_account() {
    const PlanAccount told = account_of(plan_);
    const auto list = [&](const char* heading, const std::vector<std::string>& lines) {
      if (!lines.empty()) content_.account.push_back({words_.label(heading), 0, true});
      for (const std::string& line : lines) content_.account.push_back({words_.text(line), 0, false});
    };
    list("Why this order", cost_words(plan_, options_.disassembly));
    list("Checked", told.checked);
    list("Not checked", told.not_checked);
    list("Assumed", told.assumed);
  }

  void write_contents() {
    const std::size_t few = 6;  // pages of steps that are found by leafing
    if (content_.pages.size() < few) return;
    for (std::size_t k = 0; k < content_.pages.size(); ++k) {
      const BookPage& page = content_.pages[k];
      if (content_.chapters.size() > 1 && (k == 0 || content_.pages[k - 1].chapter != page.chapter))
        content_.contents.push_back({page.chapter, k, true});
      std::string what;
      for (const auto& [item, words] : page.moving) what += (what.empty() ? "" : ", ") + words;
      content_.contents.push_back({fmt::format("{}  {}: {}", page.number, page.verb, what), k, false});
    }
    content_.contents.push_back({words_.label("What was checked"), content_.pages.size(), true});
  }

  void write_title() {
    const PlanAssembly& a = plan_.assembly;
    std::filesystem::path source(a.source);
    if (!source.has_filename()) source = source.parent_path();
    std::string title = source.filename().empty() ? a.source : source.filename().string();
    for (const char* ending : {".step", ".stp", ".glb", ".gltf", ".3mf", ".obj", ".stl", ".dae"})
      if (source.extension() == ending) title = source.stem().string();
    content_.title = options_.title.empty() ? title : options_.title;
    content_.subtitle = words_.label(options_.disassembly ? "How to take it apart" : "How to put it together");
    std::size_t units = 0;
    for (const BookItem& item : content_.items) units += item.names.size();
    fact(content_.facts, "parts",
         fmt::format("{}, {}", units,
                     content_.items.size() == 1 ? words_.text("1 shape") : said("{} shapes", content_.items.size())));
    if (!content_.base.empty()) content_.facts.emplace_back("", content_.base);
    fact(content_.facts, "steps", std::to_string(plan_.disassembly.size()));
    if (!options_.revision.empty()) fact(content_.facts, "revision", options_.revision);
    if (!a.box.empty()) {
      fact(content_.facts, "size", size_text(a.box.size(), unit_));
    }
    const Eigen::Quaterniond input = upright(frame_.up).conjugate();
    fact(content_.facts, "directions",
         said("right is {}, up is {}, the front is at {}", axis_text(input * Eigen::Vector3d::UnitX()),
              axis_text(frame_.up), axis_text(input * -Eigen::Vector3d::UnitY())));
    if (!frame_.unit_known) fact(content_.facts, "units", words_.label("those of the input, which names none"));
    fact(content_.facts, "checked",
         said("every motion, with parts that overlap by at most {} more than when assembled",
              length_of(plan_.verified_max_penetration / a.scale)));
    fact(content_.facts, "made by", plan_.generator_name + " " + plan_.generator_version);
    if (const std::string forced = forced_numbers(); !forced.empty())
      content_.warnings.push_back(said("Not verified: in these steps parts cut into others: {}.", forced));
    if (plan_.status == PlanStatus::partial)
      content_.warnings.push_back(
          fmt::format("The plan is partial: {} are still together with others at its end ({}). What the plan does not "
                      "separate is handled as one piece here.",
                      text::counted(plan_.remaining.size(), "part"), listed_names(plan_.remaining)));
    else if (plan_.asked != PlanAsked{})
      fact(content_.facts, "plan", words_.text(result_text(plan_)));
    if (!a.excluded.empty()) {
      std::vector<std::string> names;
      for (const PlanExcluded& e : a.excluded) names.push_back(e.name);
      content_.warnings.push_back(fmt::format("Left out of the plan, and not in this book: {}.", listed_names(names)));
    }
  }

  /// "2, 5": the steps that are forced and not accepted.
  std::string forced_numbers() const {
    std::vector<std::size_t> numbers;
    for (std::size_t s = 0; s < plan_.disassembly.size(); ++s)
      if (const auto& forced = plan_.disassembly[s].forced; forced && forced->accepted.empty())
        numbers.push_back(step_number(plan_, s, options_.disassembly));
    std::ranges::sort(numbers);
    return fmt::format("{}", fmt::join(numbers, ", "));
  }

  std::string length_of(double input_units) const {
    return fmt::format("{} {}", figure_text(unit_.factor * input_units), unit_.name);
  }

  std::string chapter_name(const BookChapter& chapter) const {
    if (chapter.letter < 0) return words_.label(content_.chapters.size() > 1 ? "The whole assembly" : "Assembly");
    std::string letters;  // A..Z, AA..
    for (int n = chapter.letter; n >= 0; n = n / 26 - 1)
      letters.insert(letters.begin(), static_cast<char>('A' + n % 26));
    return said("Sub-assembly {}", letters);
  }

  std::string names_of(const std::vector<std::size_t>& parts) const {
    std::vector<std::string> names;
    for (const std::size_t i : parts) names.push_back(assembly_.parts[i].name);
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
    page.count = plan_.disassembly.size();
    page.verb = words_.label(step.shifts_only       ? (options_.disassembly ? "Move aside" : "Move back")
                             : options_.disassembly ? "Take out"
                                                    : "Put in");
    std::vector<std::string> instances;
    for (const BookMover& mover : step.movers) {
      std::vector<std::string> singles;
      for (const std::size_t i : mover.parts) singles.push_back(assembly_.parts[i].name);
      const std::vector<const PlanComponent*> whole = text::take_components(plan_.assembly, singles);
      std::map<std::size_t, std::size_t> of_item;
      std::vector<std::string> others;
      for (const std::size_t i : mover.parts)
        if (std::ranges::find(singles, assembly_.parts[i].name) != singles.end()) {
          if (numbers_.of_part[i])
            ++of_item[*numbers_.of_part[i]];
          else
            others.push_back(assembly_.parts[i].name);
        }
      if (const BookChapter* built = chapter_of(mover.parts)) {
        page.box.push_back({0, 1, placed(mover.parts)});
        page.moving.emplace_back(0, said("{} ({} parts)", chapter_name(*built), built->parts.size()));
      } else {
        for (const PlanComponent* c : whole) {
          const auto item = numbers_.of_component.find(c->name);
          page.moving.emplace_back(item == numbers_.of_component.end() ? 0 : content_.items[item->second].number,
                                   c->name);
          if (item != numbers_.of_component.end()) add_to_box(page, item->second, 1);
        }
        for (const std::string& name : others) page.moving.emplace_back(0, name);
        for (const auto& [item, n] : of_item) {
          const std::string& name = content_.items[item].name;
          page.moving.emplace_back(content_.items[item].number, n == 1 ? name : fmt::format("{} × {}", n, name));
          add_to_box(page, item, n);
          for (const std::size_t i : mover.parts)
            if (numbers_.of_part[i] == item && assembly_.parts[i].name != name)
              instances.push_back(assembly_.parts[i].name);
        }
      }
      const MotionSummary motion = summarize_motion(mover.poses, mover.center, stretch_tolerance(size_));
      const std::optional<double> guided = guided_distance_of(step, mover, motion);
      const std::string who = step.movers.size() > 1 ? names_of(mover.parts) + ": " : "";
      page.motions.push_back(who +
                             words_.text(travel_words(motion, guided, {unit_, frame_.up, size_, options_.disassembly},
                                                      frame_.lies(step.up))));
      add_vectors(motion, guided, who, page.facts);
    }
    if (step.movers.empty()) page.motions.push_back(words_.label("it is apart already: nothing has to move"));
    if (step.up) fact(page.facts, "lies", words_.text(lie_words(*step.up, frame_.up)));
    if (index == 0 && !options_.disassembly) fact(page.facts, "base", names_of(chapter.base));
    if (index == 0 && options_.disassembly && chapter.letter >= 0) fact(page.facts, "of", names_of(chapter.parts));
    add_own_notes(step, page);
    if (!instances.empty()) fact(page.facts, "instance", listed_names(instances));
    add_plan_facts(plan_.disassembly[step.plan_step], page);
    content_.pages.push_back(std::move(page));
  }

  /// What the plan says about the step.
  void add_plan_facts(const PlanStep& step, BookPage& page) const {
    if (step.forced && step.forced->accepted.empty()) {
      page.warning = said("Not verified: {}.", words_.text(forced_text(unit_, *step.forced)));
      Facts why;
      if (const std::string reached = reached_text(plan_, unit_, step); !reached.empty())
        fact(why, "how far", words_.text(reached));
      if (!step.forced->reason.empty()) fact(why, "because", words_.text(step.forced->reason));
      if (const std::string advice = forced_advice(*step.forced); !advice.empty()) fact(why, "you can", advice);
      page.facts.insert(page.facts.begin(), why.begin(), why.end());  // before what may not have room
    }
    if (step.forced && !step.forced->accepted.empty())
      page.facts.emplace_back(step.forced->accepted, forced_text(unit_, *step.forced));
    for (const std::string& cut : thread_words(plan_, step)) fact(page.facts, "note", words_.text(cut + "."));
    for (const PlanVerdict& v : step.checks)
      for (const StepNote& note : v.notes) {
        const std::vector<std::string> held = held_by(note);
        for (const std::string& name : held)
          for (std::size_t i = 0; i < assembly_.parts.size(); ++i)
            if (assembly_.parts[i].name == name && !moves(*page.step, i)) page.held.push_back(i);
        const char* kind = !held.empty() ? "hold" : note.kind.starts_with("tool_access") ? "tool" : "note";
        fact(page.facts, kind, words_.text(note.text));
      }
    if (const std::string order = order_words(plan_, page.step->plan_step, options_.disassembly); !order.empty())
      fact(page.facts, "order", words_.text(order));
    if (!step.contacts.empty()) fact(page.facts, "touches", text::joined(step.contacts));
  }

  /// None for what is not one straight motion by which parts join or leave.
  std::optional<double> guided_distance_of(const BookStep& step, const BookMover& mover,
                                           const MotionSummary& motion) const {
    if (step.shifts_only || step.movers.size() != 1 || !is_straight(motion)) return std::nullopt;
    PosedParts moving, fixed;
    for (const std::size_t i : mover.parts)
      moving.emplace_back(i, options_.disassembly ? mover.poses.front() : mover.poses.back());
    for (const PlacedPart& part : step.standing) fixed.emplace_back(part.part, part.pose);
    const Eigen::Vector3d outwards = (options_.disassembly ? 1 : -1) * motion.stretches.front();
    return std::min(guided_distance(assembly_, moving, fixed, outwards), motion.length);
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

  const Plan& plan_;
  const Assembly& assembly_;
  const BookOptions& options_;
  const InputFrame frame_;
  const TextUnit unit_;
  const BookWords words_;
  const double size_;
  ItemNumbers numbers_;
  BookContent content_;
};

}  // namespace

BookContent book_content(const Plan& plan, const Assembly& assembly, const BookOptions& options,
                         const std::vector<geometry::ShapePlacement>& shapes) {
  return ContentWriter(plan, assembly, options, shapes).write();
}

}  // namespace dismantle

#include "content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "dismantle/errors.h"
#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/job_list.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/plan_io/travel.h"
#include "dismantle/plan_io/verdicts.h"

namespace dismantle {
namespace {

/// "bolt" for "bolt_1", "bolt_2"; the first name when the common beginning is too short.
std::string common_name(const std::vector<std::string>& names) {
  std::string stem = names.front();
  for (const std::string& name : names)
    stem.resize(static_cast<std::size_t>(std::ranges::mismatch(stem, name).in1 - stem.begin()));
  if (names.size() == 1) return stem;
  while (!stem.empty() && (std::isdigit(static_cast<unsigned char>(stem.back())) ||
                           std::string_view(" _-.#:(").find(stem.back()) != std::string_view::npos))
    stem.pop_back();
  while (!stem.empty() && (static_cast<unsigned char>(stem.back()) & 0x80) != 0) stem.pop_back();  // cut character
  return stem.size() >= 3 ? stem : names.front();
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
        size_(assembly.input_box.empty() ? 1 : assembly.input_box.size().maxCoeff()) {
    content_.chapters = instructions(plan_, assembly_, options_.disassembly);
    if (content_.chapters.empty())
      throw InputError(plan_.assembly.source, "the plan has no steps, so there is nothing to instruct");
    find_items(shapes);
  }

  BookContent write() {
    write_title();
    for (const BookChapter& chapter : content_.chapters)
      for (std::size_t s = 0; s < chapter.steps.size(); ++s) add_page(chapter, s);
    std::ranges::sort(content_.pages, {}, &BookPage::number);
    write_contents();
    write_job();
    return std::move(content_);
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

  void find_items(const std::vector<geometry::ShapePlacement>& shapes) {
    item_of_.resize(assembly_.parts.size());
    std::vector<bool> listed_here = handled();
    std::vector<std::string> rest;
    for (std::size_t i = 0; i < assembly_.parts.size(); ++i)
      if (!listed_here[i]) rest.push_back(assembly_.parts[i].name);
    if (!rest.empty())
      content_.base =
          fmt::format("{} that stay together are not listed: {}", text::counted(rest.size(), "part"), listed(rest));
    find_products(listed_here);
    std::map<std::size_t, std::size_t> item_of_shape;
    for (std::size_t i = 0; i < assembly_.parts.size(); ++i) {
      if (!listed_here[i]) continue;
      const auto [it, fresh] = item_of_shape.try_emplace(shapes[i].original, content_.items.size());
      if (fresh) add_item({{i, Pose{}}});
      BookItem& item = content_.items[it->second];
      item.names.push_back(assembly_.parts[i].name);
      item_of_[i] = it->second;
    }
    for (BookItem& item : content_.items)
      if (item.name.empty()) item.name = common_name(item.names);
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
      item_of_component_.emplace(component.name, it->second);
    }
  }

  void add_item(std::vector<PlacedPart> picture) {
    Aabb box;
    for (const PlacedPart& placed : picture) box.extend(assembly_.parts[placed.part].mesh->box());
    content_.items.push_back(
        {content_.items.size() + 1, {}, {}, std::move(picture), size_text(box.size() / assembly_.normalization.scale)});
  }

  void write_job() {
    const JobList job = job_list(plan_, options_.disassembly);
    if (!job.fasteners.empty()) content_.job.push_back({"Fasteners", 0, true});
    for (const JobFastener& f : job.fasteners) content_.job.push_back({fastener_words(f), 0, false});
    if (!job.tools.empty()) content_.job.push_back({"Tools", 0, true});
    for (const JobTool& t : job.tools) content_.job.push_back({tool_words(t), 0, false});
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
  }

  void write_title() {
    const PlanAssembly& a = plan_.assembly;
    std::filesystem::path source(a.source);
    if (!source.has_filename()) source = source.parent_path();
    std::string title = source.filename().empty() ? a.source : source.filename().string();
    for (const char* ending : {".step", ".stp", ".glb", ".gltf", ".3mf", ".obj", ".stl", ".dae"})
      if (source.extension() == ending) title = source.stem().string();
    content_.title = options_.title.empty() ? title : options_.title;
    content_.subtitle = options_.disassembly ? "How to take it apart" : "How to put it together";
    std::size_t units = 0;
    for (const BookItem& item : content_.items) units += item.names.size();
    content_.facts.emplace_back("parts", fmt::format("{}, {}", units, text::counted(content_.items.size(), "shape")));
    if (!content_.base.empty()) content_.facts.emplace_back("", content_.base);
    content_.facts.emplace_back("steps", std::to_string(plan_.disassembly.size()));
    if (!a.box.empty()) {
      content_.facts.emplace_back("size", size_text(a.box.size()));
    }
    const Eigen::Quaterniond input = upright(frame_.up).conjugate();
    content_.facts.emplace_back(
        "directions", fmt::format("right is {}, up is {}, the front is at {}", axis_text(input * Eigen::Vector3d::UnitX()),
                                  axis_text(frame_.up), axis_text(input * -Eigen::Vector3d::UnitY())));
    if (!frame_.unit_known) content_.facts.emplace_back("units", "those of the input, which names none");
    content_.facts.emplace_back(
        "checked", fmt::format("every motion, with parts that overlap by at most {} {} more than when assembled",
                               figure_text(unit_.factor * plan_.verified_max_penetration / a.scale), unit_.name));
    if (!plan_.objective.empty()) content_.facts.emplace_back("judged", objective_text(plan_));
    content_.facts.emplace_back("made by", plan_.generator_name + " " + plan_.generator_version);
    if (const std::string forced = forced_numbers(); !forced.empty())
      content_.warnings.push_back(fmt::format("Not verified: in these steps parts cut into others: {}.", forced));
    if (plan_.status == PlanStatus::partial)
      content_.warnings.push_back(
          fmt::format("The plan is partial: {} are still together with others at its end ({}). What the plan does not "
                      "separate is handled as one piece here.",
                      text::counted(plan_.remaining.size(), "part"), listed(plan_.remaining)));
    else if (plan_.asked != PlanAsked{})
      content_.facts.emplace_back("plan", result_text(plan_));
    if (!a.excluded.empty()) {
      std::vector<std::string> names;
      for (const PlanExcluded& e : a.excluded) names.push_back(e.name);
      content_.warnings.push_back(fmt::format("Left out of the plan, and not in this book: {}.", listed(names)));
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

  /// `box`: input units.
  std::string size_text(Eigen::Vector3d box) const {
    box *= unit_.factor;
    return fmt::format("{} × {} × {} {}", figure_text(box.x()), figure_text(box.y()), figure_text(box.z()), unit_.name);
  }

  std::string chapter_name(const BookChapter& chapter) const {
    if (chapter.letter < 0) return content_.chapters.size() > 1 ? "The whole assembly" : "Assembly";
    std::string letters;  // A..Z, AA..
    for (int n = chapter.letter; n >= 0; n = n / 26 - 1)
      letters.insert(letters.begin(), static_cast<char>('A' + n % 26));
    return "Sub-assembly " + letters;
  }

  std::string names_of(const std::vector<std::size_t>& parts) const {
    std::vector<std::string> names;
    for (const std::size_t i : parts) names.push_back(assembly_.parts[i].name);
    return listed(std::move(names));
  }

  static std::string listed(std::vector<std::string> names) {
    const std::size_t most = 8;  // largest number of names in a sentence
    if (names.size() <= most) return text::joined(names);
    const std::size_t more = names.size() - most + 1;
    names.resize(most - 1);
    return fmt::format("{} and {} more", text::joined(names), more);
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
    page.verb = step.shifts_only       ? (options_.disassembly ? "Move aside" : "Move back")
                : options_.disassembly ? "Take out"
                                       : "Put in";
    for (const BookMover& mover : step.movers) {
      std::vector<std::string> singles;
      for (const std::size_t i : mover.parts) singles.push_back(assembly_.parts[i].name);
      const std::vector<const PlanComponent*> whole = text::take_components(plan_.assembly, singles);
      std::map<std::size_t, std::size_t> of_item;
      std::vector<std::string> others;
      for (const std::size_t i : mover.parts)
        if (std::ranges::find(singles, assembly_.parts[i].name) != singles.end()) {
          if (item_of_[i])
            ++of_item[*item_of_[i]];
          else
            others.push_back(assembly_.parts[i].name);
        }
      if (const BookChapter* built = chapter_of(mover.parts)) {
        page.moving.emplace_back(0, fmt::format("{} ({} parts)", chapter_name(*built), built->parts.size()));
      } else {
        for (const PlanComponent* c : whole) {
          const auto item = item_of_component_.find(c->name);
          page.moving.emplace_back(item == item_of_component_.end() ? 0 : content_.items[item->second].number, c->name);
        }
        for (const std::string& name : others) page.moving.emplace_back(0, name);
        for (const auto& [item, n] : of_item)
          page.moving.emplace_back(content_.items[item].number,
                                   n == 1 && mover.parts.size() == 1
                                       ? assembly_.parts[mover.parts.front()].name
                                       : fmt::format("{} × {}", n, content_.items[item].name));
      }
      const MotionSummary motion = summarize_motion(mover.poses, mover.center, leg_tolerance(size_));
      const std::optional<double> guided = guided_distance_of(step, mover, motion);
      const std::string who = step.movers.size() > 1 ? names_of(mover.parts) + ": " : "";
      page.motions.push_back(
          who + travel_words(motion, guided, {unit_, frame_.up, size_, options_.disassembly}, frame_.lies(step.up)));
      add_vectors(motion, guided, who, page.facts);
    }
    if (step.movers.empty()) page.motions.emplace_back("it is apart already: nothing has to move");
    if (step.up) {
      page.facts.emplace_back("lies", lie_words(*step.up, frame_.up));
    }
    if (index == 0 && !options_.disassembly) page.facts.emplace_back("base", names_of(chapter.base));
    if (index == 0 && options_.disassembly && chapter.letter >= 0)
      page.facts.emplace_back("of", names_of(chapter.parts));
    add_plan_facts(plan_.disassembly[step.plan_step], page);
    content_.pages.push_back(std::move(page));
  }

  /// What the plan says about the step.
  void add_plan_facts(const PlanStep& step, BookPage& page) const {
    if (step.forced && step.forced->accepted.empty()) {
      page.warning = fmt::format("Not verified: {}.", forced_text(unit_, *step.forced));
      Facts why;
      if (!step.forced->reason.empty()) why.emplace_back("because", step.forced->reason);
      if (const std::string advice = forced_advice(*step.forced); !advice.empty()) why.emplace_back("you can", advice);
      page.facts.insert(page.facts.begin(), why.begin(), why.end());  // before what may not have room
    }
    if (step.forced && !step.forced->accepted.empty())
      page.facts.emplace_back(step.forced->accepted, forced_text(unit_, *step.forced));
    if (!step.contacts.empty()) page.facts.emplace_back("touches", text::joined(step.contacts));
    for (const PlanVerdict& v : step.checks)
      for (const StepNote& note : v.notes) page.facts.emplace_back("note", note.text);
    for (const std::string& line : cost_lines(step.checks)) page.facts.emplace_back("check", line);
    if (!options_.disassembly)
      page.facts.emplace_back("reverse of", fmt::format("step {} of the disassembly", step.step));
  }

  /// None for what is not one straight motion by which parts join or leave.
  std::optional<double> guided_distance_of(const BookStep& step, const BookMover& mover,
                                           const MotionSummary& motion) const {
    if (step.shifts_only || step.movers.size() != 1 || !is_straight(motion)) return std::nullopt;
    PosedParts moving, fixed;
    for (const std::size_t i : mover.parts)
      moving.emplace_back(i, options_.disassembly ? mover.poses.front() : mover.poses.back());
    for (const PlacedPart& part : step.standing) fixed.emplace_back(part.part, part.pose);
    const Eigen::Vector3d outwards = (options_.disassembly ? 1 : -1) * motion.legs.front();
    return std::min(guided_distance(assembly_, moving, fixed, outwards), motion.length);
  }

  void add_vectors(const MotionSummary& motion, std::optional<double> guided, const std::string& who,
                   Facts& facts) const {
    if (motion.length > 0 && motion.displacement.norm() > 1e-6 * size_) {
      const Eigen::Vector3d d = motion.displacement.normalized();
      const auto rounded = [](double x) { return std::round(1000 * x) / 1000 + 0.0; };
      facts.emplace_back("direction",
                         fmt::format("{}({}, {}, {})", who, rounded(d.x()), rounded(d.y()), rounded(d.z())));
      if (!guided)
        facts.emplace_back("distance", who + length_of(motion.displacement.norm()));
      else if (const double distance = stated_distance(motion, guided, size_); distance > 0)
        facts.emplace_back("distance", who + length_of(distance));
    }
    if (motion.length > 1.01 * motion.displacement.norm())
      facts.emplace_back("length of the path", who + length_of(motion.length));
  }

  const Plan& plan_;
  const Assembly& assembly_;
  const BookOptions& options_;
  const InputFrame frame_;
  const TextUnit unit_;
  const double size_;
  std::vector<std::optional<std::size_t>> item_of_;  // by part; none: it has no item of its own
  std::map<std::string, std::size_t> item_of_component_;
  BookContent content_;
};

}  // namespace

BookContent book_content(const Plan& plan, const Assembly& assembly, const BookOptions& options,
                         const std::vector<geometry::ShapePlacement>& shapes) {
  return ContentWriter(plan, assembly, options, shapes).write();
}

}  // namespace dismantle

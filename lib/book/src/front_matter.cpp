#include "front_matter.h"

#include <algorithm>
#include <filesystem>

#include "dismantle/plan_io/explain.h"
#include "dismantle/plan_io/job_list.h"
#include "dismantle/plan_io/plan_account.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/summary.h"
#include "dismantle/plan_io/text_columns.h"
#include "items.h"

namespace dismantle {
namespace {

class FrontWriter : private ContentBasis {
 public:
  FrontWriter(BookContent& content, const ContentBasis& basis) : ContentBasis(basis), content_(content) {}

  void write() {
    write_title();
    write_contents();
    write_job();
    write_account();
  }

 private:
  void write_job() {
    const JobList job = job_list(plan, options.disassembly);
    if (!job.fasteners.empty()) content_.job.push_back({words.label("Fasteners"), 0, true});
    for (const JobFastener& f : job.fasteners) content_.job.push_back({fastener_words(f), 0, false});
    if (!job.tools.empty()) content_.job.push_back({words.label("Tools"), 0, true});
    for (const JobTool& t : job.tools) content_.job.push_back({tool_words(t), 0, false});
  }

  void write_account() {
    const PlanAccount told = account_of(plan);
    const auto list = [&](const char* heading, const std::vector<std::string>& lines) {
      if (!lines.empty()) content_.account.push_back({words.label(heading), 0, true});
      for (const std::string& line : lines) content_.account.push_back({words.text(line), 0, false});
    };
    list("Why this order", cost_words(plan, options.disassembly));
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
      for (const auto& [item, name] : page.moving) what += (what.empty() ? "" : ", ") + name;
      content_.contents.push_back({fmt::format("{}  {}: {}", page.numbers(), page.verb, what), k, false});
    }
    content_.contents.push_back({words.label("What was checked"), content_.pages.size(), true});
  }

  void write_title() {
    const PlanAssembly& a = plan.assembly;
    std::filesystem::path source(a.source);
    if (!source.has_filename()) source = source.parent_path();
    std::string title = source.filename().empty() ? a.source : source.filename().string();
    for (const char* ending : {".step", ".stp", ".glb", ".gltf", ".3mf", ".obj", ".stl", ".dae"})
      if (source.extension() == ending) title = source.stem().string();
    content_.title = options.title.empty() ? title : options.title;
    content_.subtitle = words.label(options.disassembly ? "How to take it apart" : "How to put it together");
    std::size_t units = 0;
    for (const BookItem& item : content_.items) units += item.names.size();
    fact(content_.facts, "parts",
         fmt::format("{}, {}", units,
                     content_.items.size() == 1 ? words.text("1 shape") : said("{} shapes", content_.items.size())));
    if (!content_.base.empty()) content_.facts.emplace_back("", content_.base);
    fact(content_.facts, "steps", std::to_string(plan.disassembly.size()));
    if (!options.revision.empty()) fact(content_.facts, "revision", options.revision);
    if (!a.box.empty()) {
      fact(content_.facts, "size", size_text(a.box.size(), unit));
    }
    const Eigen::Quaterniond input = upright(frame.up).conjugate();
    fact(content_.facts, "directions",
         said("right is {}, up is {}, the front is at {}", axis_text(input * Eigen::Vector3d::UnitX()),
              axis_text(frame.up), axis_text(input * -Eigen::Vector3d::UnitY())));
    if (!frame.unit_known) fact(content_.facts, "units", words.label("those of the input, which names none"));
    fact(content_.facts, "checked",
         said("every motion, with parts that overlap by at most {} more than when assembled",
              length_of(plan.verified_max_penetration / a.scale)));
    fact(content_.facts, "made by", plan.generator_name + " " + plan.generator_version);
    if (const std::string forced = forced_numbers(); !forced.empty())
      content_.warnings.push_back(said("Not verified: in these steps parts cut into others: {}.", forced));
    if (plan.status == PlanStatus::partial)
      content_.warnings.push_back(
          fmt::format("The plan is partial: {} are still together with others at its end ({}). What the plan does not "
                      "separate is handled as one piece here.",
                      text::counted(plan.remaining.size(), "part"), listed_names(plan.remaining)));
    else if (plan.asked != PlanAsked{})
      fact(content_.facts, "plan", words.text(result_text(plan)));
    if (!a.excluded.empty()) {
      std::vector<std::string> names;
      for (const PlanExcluded& e : a.excluded) names.push_back(e.name);
      content_.warnings.push_back(fmt::format("Left out of the plan, and not in this book: {}.", listed_names(names)));
    }
  }

  /// "2, 5": the steps that are forced and not accepted.
  std::string forced_numbers() const {
    std::vector<std::size_t> numbers;
    for (std::size_t s = 0; s < plan.disassembly.size(); ++s)
      if (const auto& forced = plan.disassembly[s].forced; forced && forced->accepted.empty())
        numbers.push_back(step_number(plan, s, options.disassembly));
    std::ranges::sort(numbers);
    return fmt::format("{}", fmt::join(numbers, ", "));
  }

  BookContent& content_;
};

}  // namespace

void write_front_matter(BookContent& content, const ContentBasis& basis) { FrontWriter(content, basis).write(); }

}  // namespace dismantle

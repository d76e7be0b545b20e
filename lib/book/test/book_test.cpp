// Instructions put every part in once, sub-assemblies first, and end in the assembled position; also in HTML and PDF.
#include "dismantle/book/book.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "dismantle/errors.h"
#include "dismantle/testing/shapes.h"
#include "instructions.h"
#include "row_plan.h"

namespace dismantle {
namespace {

TEST(Instructions, EachPartJoinsOnceAndEndsWhereItBelongs) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 60; ++trial) {
    const Assembly assembly = row_of(2 + trial % 9);
    const Plan plan = random_plan(assembly, random);
    const auto chapters = instructions(plan, assembly, false);
    std::set<std::vector<std::size_t>> built;  // sub-assemblies that are ready
    std::size_t steps = 0;
    for (const BookChapter& chapter : chapters) {
      std::vector<std::size_t> together = chapter.base;
      for (const BookStep& step : chapter.steps) {
        ++steps;
        ASSERT_EQ(step.movers.size(), 1u);
        const auto& joins = step.movers[0].parts;
        if (joins.size() > 1) {
          EXPECT_TRUE(built.contains(joins)) << "a sub-assembly is put in before it is built";
        }
        std::vector<std::size_t> standing;
        for (const PlacedPart& p : step.standing) {
          standing.push_back(p.part);
          EXPECT_TRUE(p.pose.is_identity(1e-9)) << "what stands is as assembled, whatever was moved before";
        }
        std::ranges::sort(together);
        EXPECT_EQ(standing, together);
        EXPECT_TRUE(step.movers[0].poses.back().is_identity(1e-9)) << "it ends in its place";
        EXPECT_FALSE(step.movers[0].poses.front().is_identity(1e-3));
        together.insert(together.end(), joins.begin(), joins.end());
      }
      std::ranges::sort(together);
      EXPECT_EQ(together, chapter.parts);
      built.insert(chapter.parts);
    }
    EXPECT_EQ(steps, plan.disassembly.size());
    EXPECT_EQ(chapters.back().parts.size(), assembly.parts.size());
    EXPECT_EQ(chapters.back().letter, -1);
  }
}

// A step has one number in each mode: that of the page and of the lists, also where sub-assemblies are built in
// between.
TEST(Instructions, StepsHaveTheNumbersOfThePlan) {
  std::mt19937 random(15);
  for (int trial = 0; trial < 20; ++trial) {
    const Assembly assembly = row_of(2 + trial % 9);
    const Plan plan = random_plan(assembly, random);
    const std::size_t count = plan.disassembly.size();
    for (const bool disassembly : {false, true}) {
      std::set<std::size_t> numbers;
      int last = -1;
      std::map<int, std::size_t> first;
      for (const BookChapter& chapter : instructions(plan, assembly, disassembly)) {
        first[chapter.letter] = chapter.steps.front().number;
        for (const BookStep& step : chapter.steps) {
          EXPECT_EQ(step.number, disassembly ? step.plan_step + 1 : count - step.plan_step);
          numbers.insert(step.number);
        }
      }
      EXPECT_EQ(numbers.size(), count);
      std::size_t before = 0;
      for (const auto& [letter, number] : first) {
        if (letter < 0) continue;
        EXPECT_EQ(letter, ++last) << "letters without a gap";
        EXPECT_GT(number, before) << "in the order of the pages";
        before = number;
      }
    }
  }
}

TEST(Instructions, TakingApartIsTheSameBackwards) {
  std::mt19937 random(12);
  for (int trial = 0; trial < 20; ++trial) {
    const Assembly assembly = row_of(2 + trial % 7);
    const Plan plan = random_plan(assembly, random);
    std::multiset<std::size_t> forward, backward;
    const auto chapters = instructions(plan, assembly, true);
    EXPECT_EQ(chapters.front().letter, -1) << "the whole comes apart first";
    for (const BookChapter& chapter : chapters) {
      for (std::size_t s = 1; s < chapter.steps.size(); ++s)
        EXPECT_LT(chapter.steps[s - 1].plan_step, chapter.steps[s].plan_step);
      for (const BookStep& step : chapter.steps) {
        forward.insert(step.plan_step);
        EXPECT_TRUE(step.movers.at(0).poses.front().is_identity(1e-9));
      }
    }
    for (const BookChapter& chapter : instructions(plan, assembly, false))
      for (const BookStep& step : chapter.steps) backward.insert(step.plan_step);
    EXPECT_EQ(forward, backward);
    EXPECT_EQ(forward.size(), plan.disassembly.size());
  }
}

BookOptions options_with(const std::string& title) {
  BookOptions out;
  out.title = title;
  return out;
}

TEST(Book, HtmlHasAPagePerStepAndNamesEveryPart) {
  std::mt19937 random(13);
  const Assembly assembly = row_of(5);
  Plan plan = random_plan(assembly, random);
  BookOptions options;
  options.title = "<b>&\"title\"";
  std::size_t pages = 0;
  options.on_page = [&](std::size_t page, std::size_t count) {
    EXPECT_EQ(page, ++pages);
    EXPECT_EQ(count, plan.disassembly.size());
  };
  const std::string html = book_html(plan, assembly, options);
  EXPECT_EQ(pages, plan.disassembly.size());
  EXPECT_NE(html.find("<h1>&lt;b&gt;&amp;&quot;title&quot;</h1>"), std::string::npos);
  std::size_t sections = 0;
  for (std::size_t at = html.find("<section"); at != std::string::npos; at = html.find("<section", at + 1)) ++sections;
  EXPECT_EQ(sections, 3 + pages) << "title, materials, what was checked";
  for (const Part& part : assembly.parts) EXPECT_NE(html.find(part.name), std::string::npos);
  // p0 and p3, p1 and p4 are the same boxes.
  EXPECT_NE(html.find("5, 3 shapes"), std::string::npos);
  EXPECT_EQ(html.find("http"), html.find("http-equiv")) << "no address of any host";
  EXPECT_EQ(html, book_html(plan, assembly, options_with(options.title)));
}

TEST(Book, PagesAreInTheOrderOfTheirNumbersAndWarningsNameThem) {
  std::mt19937 random(16);
  const Assembly assembly = row_of(7);
  Plan plan = random_plan(assembly, random);
  const std::size_t count = plan.disassembly.size();
  plan.disassembly[1].forced = PlanForced{.part = "p0", .other = "p1", .depth = 0.01, .reason = "it is pressed in"};
  for (const bool disassembly : {false, true}) {
    BookOptions options;
    options.disassembly = disassembly;
    const std::string html = book_html(plan, assembly, options);
    std::size_t at = 0;
    for (std::size_t number = 1; number <= count; ++number) {
      at = html.find("<span>step " + std::to_string(number) + " of " + std::to_string(count) + "</span>", at);
      ASSERT_NE(at, std::string::npos) << number;
    }
    const std::size_t forced = disassembly ? 2 : count - 1;
    EXPECT_NE(html.find("in these steps parts cut into others: " + std::to_string(forced) + "."), std::string::npos);
    const std::size_t page = html.find("id=\"step-" + std::to_string(forced) + "\"");
    EXPECT_LT(page, html.find("Not verified: p0 cuts")) << "the page of that number says so";
    EXPECT_LT(html.find("Not verified: p0 cuts"), html.find("</section>", page));
    EXPECT_NE(html.find("<dt>because</dt><dd>it is pressed in</dd>"), std::string::npos);
    EXPECT_NE(html.find("constraints: {accept: "), std::string::npos) << "and how to accept it";
  }
}

TEST(Book, PdfHasAPagePerStep) {
  std::mt19937 random(14);
  const Assembly assembly = row_of(4);
  const Plan plan = random_plan(assembly, random);
  const std::string pdf = book_pdf(plan, assembly, {});
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_NE(pdf.find("/Count " + std::to_string(3 + plan.disassembly.size())), std::string::npos);
}

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

TEST(Book, AThickBookHasATableOfContents) {
  std::mt19937 random(17);
  const Assembly assembly = row_of(8);
  const Plan plan = random_plan(assembly, random);
  const std::string html = book_html(plan, assembly, {});
  const std::string contents =
      html.substr(html.find("id=\"contents\""), html.find("Bill of materials") - html.find("id=\"contents\""));
  for (std::size_t number = 1; number <= plan.disassembly.size(); ++number) {
    const std::string place = "step-" + std::to_string(number) + "\"";
    EXPECT_NE(contents.find("href=\"#" + place), std::string::npos) << number;
    EXPECT_NE(html.find("id=\"" + place), std::string::npos) << number;
  }
  EXPECT_NE(book_pdf(plan, assembly, {}).find("/Count " + std::to_string(4 + plan.disassembly.size())),
            std::string::npos);
}

// A page of its own, after the bill of materials, if there are any.
TEST(Book, ListsTheFastenersAndToolsOfTheJob) {
  std::mt19937 random(19);
  const Assembly assembly = row_of(8);
  Plan plan = random_plan(assembly, random);
  EXPECT_EQ(book_html(plan, assembly, {}).find("Fasteners and tools"), std::string::npos);
  plan.assembly.parts[0].kind = PartKind{"screw", "M3x10", 1};
  plan.assembly.parts[5].kind = PartKind{"screw", "M3x10", 1};
  plan.disassembly[0].checks.push_back(
      {.type = "tool_access",
       .notes = {{"tool_access.tool", "", R"({"part": "p5", "tool": "hex_key_2.5", "name": "hex key 2.5"})"}}});
  const std::string html = book_html(plan, assembly, {});
  EXPECT_NE(html.find("<p>2x screw M3x10: hex key 2.5</p>"), std::string::npos);
  EXPECT_NE(html.find("<div class=\"soft\">screw M3x10, "), std::string::npos) << "and the bill of materials says it";
  EXPECT_NE(html.find("<p>hex key 2.5: 1x M3x10, step " + std::to_string(plan.disassembly.size()) + "</p>"),
            std::string::npos);
  BookOptions apart;
  apart.disassembly = true;
  EXPECT_NE(book_html(plan, assembly, apart).find("<p>hex key 2.5: 1x M3x10, step 1</p>"), std::string::npos);
  EXPECT_NE(book_pdf(plan, assembly, {}).find("/Count " + std::to_string(5 + plan.disassembly.size())),
            std::string::npos);
}

// The last page: what was checked, not checked, assumed, and why this order; each step says what it waits for.
TEST(Book, SaysWhatWasCheckedAndWhyThisOrder) {
  std::mt19937 random(23);
  const Assembly assembly = row_of(8);
  Plan plan = random_plan(assembly, random);
  const std::size_t n = plan.disassembly.size();
  for (PlanStep& step : plan.disassembly) step.layer = 1;
  plan.disassembly[3].after = {1, 2};
  plan.objective.checks = {{.type = "directions", .cost = 2}};
  plan.objective.cost = 2;
  plan.disassembly[3].checks = {{.type = "directions", .cost = 2}};
  const std::string html = book_html(plan, assembly, {});
  const std::string account = html.substr(html.find("<section id=\"account\">"));
  for (const char* heading : {"Why this order", "Checked", "Not checked", "Assumed"})
    EXPECT_NE(account.find("<h3>" + std::string(heading) + "</h3>"), std::string::npos) << heading;
  EXPECT_NE(account.find("directions: costs 2 of 2, in step " + std::to_string(n - 3)), std::string::npos);
  EXPECT_NE(html.find("<a href=\"#account\">What was checked</a>"), std::string::npos);
  EXPECT_GT(html.find("<section id=\"account\">"), html.find("id=\"step-" + std::to_string(n) + "\""));
  const std::string page = html.substr(html.find("id=\"step-" + std::to_string(n - 3) + "\""));
  EXPECT_NE(page.substr(0, page.find("</section>")).find("before steps " + std::to_string(n - 1)), std::string::npos);
}

/// The plan takes out p0 and then p1; the others stay together.
Plan repair_plan(const Assembly& assembly) {
  Plan plan;
  plan.assembly.source = "row/";
  plan.assembly.box = assembly.input_box;
  for (const Part& part : assembly.parts) plan.assembly.parts.push_back({part.id, part.name, part.file});
  for (const char* name : {"p0", "p1"}) {
    PlanStep step;
    step.step = static_cast<unsigned>(plan.disassembly.size() + 1);
    step.moves = {{name, {Pose{}, Pose{{0, 0, 1}, Eigen::Quaterniond::Identity()}}}};
    step.separates = {{name}};
    plan.disassembly.push_back(step);
  }
  for (std::size_t i = 2; i < assembly.parts.size(); ++i) plan.remaining.push_back(assembly.parts[i].name);
  plan.asked.target = "p1";
  plan.status = PlanStatus::complete;
  return plan;
}

TEST(Book, TheBillOfMaterialsHasWhatTheBookHandles) {
  const Assembly assembly = row_of(9);
  Plan plan = repair_plan(assembly);
  const std::string html = book_html(plan, assembly, {});
  EXPECT_EQ(count_of(html, "<div class=\"item\">"), 2u);
  EXPECT_NE(html.find("7 parts that stay together are not listed"), std::string::npos);
  EXPECT_NE(html.find("<dd>2, 2 shapes</dd>"), std::string::npos);
}

// A number that tells parts apart is no part of their common name; the size of a thread is.
TEST(Book, ItemsKeepWhatTheirNamesHaveInCommon) {
  const auto item_of = [](std::vector<std::string> names) {
    Assembly assembly = row_of(2);
    Plan plan = repair_plan(assembly);
    for (std::size_t k = 0; k < 2; ++k) {
      Part& part = assembly.parts[k];
      plan.assembly.parts[k].name = plan.disassembly[k].moves[0].part = plan.disassembly[k].separates[0][0] =
          part.name = names[k];
      part.mesh = part.surface = assembly.parts[0].mesh;
    }
    plan.disassembly.pop_back();
    plan.remaining = {names[1]};
    plan.asked = {};
    const std::string html = book_html(plan, assembly, {});
    EXPECT_EQ(count_of(html, "<div class=\"item\">"), 1u);
    const std::size_t at = html.find("<strong>") + 8;
    return html.substr(at, html.find("</strong>") - at);
  };
  EXPECT_EQ(item_of({"bolt_M10_1", "bolt_M10_2"}), "bolt_M10");
  EXPECT_EQ(item_of({"bolt_M10_1", "bolt_M10_12"}), "bolt_M10");
  EXPECT_EQ(item_of({"bolt_9", "bolt_10"}), "bolt");
  EXPECT_EQ(item_of({"6002", "6002#2"}), "6002");
  EXPECT_EQ(item_of({"a1", "a2"}), "a1") << "too short";
}

TEST(Book, AProductThatIsKeptTogetherIsOneItem) {
  const Assembly assembly = row_of(4);
  Plan plan = repair_plan(assembly);
  plan.disassembly.pop_back();
  plan.disassembly[0].moves.push_back({"p1", plan.disassembly[0].moves[0].poses});
  plan.disassembly[0].separates = {{"p0", "p1"}};
  plan.assembly.components = {{"motor 1", "motor", {"p0", "p1"}, true, ""}, {"case", "case", {"p2", "p3"}, true, ""}};
  const std::string html = book_html(plan, assembly, {});
  EXPECT_EQ(count_of(html, "<div class=\"item\">"), 2u) << "the motor, and the case that it is put into";
  EXPECT_NE(html.find("<strong>motor</strong>"), std::string::npos);
  EXPECT_NE(html.find("<span class=\"badge\">1</span>motor 1</div>"), std::string::npos) << "the page has its number";
  EXPECT_EQ(html.find("not listed"), std::string::npos);
}

TEST(Book, CirclesNumberWhatMovesAndWhatIsHeld) {
  std::mt19937 random(21);
  const Assembly assembly = row_of(5);
  Plan plan = random_plan(assembly, random);
  std::size_t moved = 0;
  for (const auto& chapter : instructions(plan, assembly, false)) moved += chapter.steps.size();
  const std::string html = book_html(plan, assembly, {});
  EXPECT_EQ(count_of(html, "<div class=\"box\">"), moved) << "a box of parts on each page";
  EXPECT_GE(count_of(html, "<svg"), moved) << "and circles in its picture";
  EXPECT_EQ(count_of(html, "<g class=\"held\">"), 0u);
  std::string other;  // a part that the last step of the disassembly leaves
  for (const Part& part : assembly.parts)
    if (part.name != plan.disassembly[0].moves[0].part) other = part.name;
  for (const PlanMove& move : plan.disassembly[0].moves) ASSERT_NE(move.part, other);
  plan.disassembly[0].checks.push_back(
      {.type = "gravity", .notes = {{"hold", "Hold it.", R"({"hold": [{"part": ")" + other + R"("}]})"}}});
  const std::string held = book_html(plan, assembly, {});
  EXPECT_EQ(count_of(held, "<g class=\"held\">"), 1u);
  EXPECT_NE(held.find("<dt>hold</dt><dd>Hold it.</dd>"), std::string::npos);
}

TEST(Book, HasARevisionNotesAndALanguage) {
  std::mt19937 random(22);
  const Assembly assembly = row_of(3);
  const Plan plan = random_plan(assembly, random);
  BookOptions options;
  options.revision = "B <2>";
  BookNote note{{}, "Grease & wipe"};
  for (const PlanMove& move : plan.disassembly[0].moves) note.parts.insert(note.parts.begin(), move.part);
  options.notes = {note, {{"p0", "p1", "p2"}, "of no step"}};
  options.language = "de";
  options.phrases = {{"step {} of {}", "Schritt {} von {}"}, {"Bill of materials", "Stückliste"}};
  const std::string html = book_html(plan, assembly, options);
  EXPECT_NE(html.find("<html lang=\"de\">"), std::string::npos);
  EXPECT_NE(html.find("<h2>Stückliste</h2>"), std::string::npos);
  EXPECT_NE(html.find("<span>Schritt 1 von 2</span>"), std::string::npos);
  EXPECT_NE(html.find("<dt>revision</dt><dd>B &lt;2&gt;</dd>"), std::string::npos);
  EXPECT_EQ(count_of(html, "Grease &amp; wipe"), 1u);
  EXPECT_EQ(count_of(html, "of no step"), 0u);
  options.phrases["step {} of {}"] = "Schritt {}";
  EXPECT_THROW(book_html(plan, assembly, options), Error);
}

TEST(Book, APlanWithoutStepsIsRefused) {
  const Assembly assembly = row_of(2);
  Plan plan;
  for (const Part& part : assembly.parts) plan.assembly.parts.push_back({part.id, part.name, part.file});
  EXPECT_THROW(book_html(plan, assembly, {}), InputError);
}

}  // namespace
}  // namespace dismantle

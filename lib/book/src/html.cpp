// The book as HTML.
#include <fmt/format.h>

#include "canvas.h"
#include "content.h"
#include "dismantle/plan_io/base64.h"
#include "dismantle/plan_io/markup.h"

namespace dismantle {
namespace {

const char* book_style() {
  return R"(
:root { --ink: #20242c; --soft: #667085; --line: #d7dce3; --accent: #c2410c; --paper: #fff; }
* { box-sizing: border-box; }
body { margin: 0; background: #eef0f3; color: var(--ink); font: 15px/1.45 system-ui, "DejaVu Sans", sans-serif; }
section { background: var(--paper); max-width: 1120px; margin: 18px auto; padding: 28px 34px; border-radius: 6px;
  box-shadow: 0 1px 4px #0002; }
h1 { font-size: 34px; margin: 0 0 4px; overflow-wrap: anywhere; }
h2 { font-size: 22px; margin: 0 0 12px; }
h3 { font-size: 16px; margin: 18px 0 4px; }
p { margin: 6px 0; }
img { max-width: 100%; height: auto; display: block; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 3px 14px; margin: 10px 0 0; font-size: 14px; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
.soft { color: var(--soft); } .forced { color: #c00; font-weight: bold; } .warning { border-left: 4px solid var(--accent); padding: 4px 12px; background: #fff4ec; }
.title { display: grid; grid-template-columns: 1fr 1fr; gap: 24px; align-items: center; }
.items { display: grid; grid-template-columns: repeat(auto-fill, minmax(190px, 1fr)); gap: 14px; }
.item { border: 1px solid var(--line); border-radius: 6px; padding: 10px; break-inside: avoid; overflow-wrap: anywhere; font-size: 14px; }
.badge { display: inline-block; min-width: 1.7em; text-align: center; border: 1.5px solid var(--ink); border-radius: 1em;
  padding: 0 .4em; font-weight: 600; font-size: 13px; margin-right: 6px; }
.count { float: right; font-weight: 600; }
.head { display: flex; justify-content: space-between; gap: 20px; color: var(--soft); border-bottom: 1px solid var(--line);
  padding-bottom: 6px; margin-bottom: 14px; }
.step { display: grid; grid-template-columns: 2fr 1fr; gap: 22px; }
.number { font-size: 44px; font-weight: 700; line-height: 1; }
.do { font-size: 19px; margin: 10px 0; } .do .what { font-weight: 600; overflow-wrap: anywhere; }
.motion { font-weight: 600; color: var(--accent); }
.contents { columns: 2; column-gap: 34px; font-size: 14px; } .contents p { margin: 2px 0; overflow-wrap: anywhere; break-inside: avoid; }
.contents a { color: inherit; text-decoration: none; } .contents .heading { font-weight: 600; margin-top: 8px; break-after: avoid; }
.picture { position: relative; max-width: max-content; } .picture svg { position: absolute; inset: 0; width: 100%; height: 100%; }
.picture path { stroke: #20242c; stroke-width: 1.1; } .picture circle { fill: #fff; stroke: #20242c; stroke-width: 1.3; } .picture .dot { fill: #20242c; }
.picture text { text-anchor: middle; dominant-baseline: central; font-weight: 600; fill: #20242c; }
.picture .held path, .picture .held circle { stroke: #0b7a93; } .picture .held .dot { fill: #0b7a93; } .picture .held text { fill: #0b7a93; }
.box { display: flex; flex-wrap: wrap; gap: 6px 14px; border: 1px solid var(--line); border-radius: 6px; padding: 6px 12px; margin-bottom: 10px; width: max-content; max-width: 100%; }
.box div { text-align: center; font-size: 13px; } .own { border-left: 4px solid #0b7a93; padding: 4px 12px; background: #eef8fa; white-space: pre-line; overflow-wrap: anywhere; }
.after { border: 1px solid var(--line); border-radius: 6px; padding: 6px; margin-top: 12px; }
.after p { font-size: 13px; color: var(--soft); margin: 0 0 4px; }
@media (max-width: 760px) { .step, .title { grid-template-columns: 1fr; } section { padding: 18px; } }
@media print { @page { size: A4 landscape; margin: 9mm 9mm 12mm; @bottom-right { content: counter(page); font: 9pt sans-serif; } } body { background: none; }
  section { margin: 0; max-width: none; box-shadow: none; padding: 0; break-after: page; } section:last-child { break-after: auto; } }
)";
}

/// Circles with numbers and their lines over a picture; nothing for none.
std::string balloons_svg(const Picture& picture) {
  if (picture.balloons.empty()) return {};
  const double radius = balloon_radius(picture.image.width);
  std::string out = fmt::format("<svg viewBox=\"0 0 {} {}\">", picture.image.width, picture.image.height);
  for (const Balloon& b : picture.balloons)
    out += fmt::format(
        "<g{}><path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/><circle class=\"dot\" cx=\"{:.1f}\" cy=\"{:.1f}\" "
        "r=\"2\"/><circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/><text x=\"{:.1f}\" y=\"{:.1f}\" "
        "font-size=\"{:.1f}\">{}</text></g>",
        b.held ? " class=\"held\"" : "", b.at.x(), b.at.y(), b.middle.x(), b.middle.y(), b.at.x(), b.at.y(),
        b.middle.x(), b.middle.y(), radius, b.middle.x(), b.middle.y(), b.number < 100 ? 1.15 * radius : 0.9 * radius,
        b.number);
  return out + "</svg>";
}

std::string plain_img(const Picture& picture, const std::string& alt) {
  return fmt::format("<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">",
                     picture.image.width, picture.image.height, escaped_markup(alt), base64(png_of(picture)));
}

std::string img(const Picture& picture, const std::string& alt) {
  return fmt::format("<div class=\"picture\">{}{}</div>", plain_img(picture, alt), balloons_svg(picture));
}

std::string facts_list(const Facts& facts) {
  std::string out = "<dl>";
  for (const auto& [name, value] : facts)
    out += fmt::format("<dt>{}</dt><dd>{}</dd>", escaped_markup(name), escaped_markup(value));
  return out + "</dl>";
}

std::string badge(std::size_t number) {
  return number == 0 ? "" : fmt::format("<span class=\"badge\">{}</span>", number);
}

/// A section, or nothing.
std::string contents_list(const BookContent& content, const std::string& title) {
  if (content.contents.empty()) return {};
  std::string out = "<section id=\"contents\"><h2>" + title + "</h2><div class=\"contents\">\n";
  for (const ContentsLine& line : content.contents)
    out += fmt::format("<p{}><a href=\"#{}\">{}</a></p>\n", line.heading ? " class=\"heading\"" : "",
                       line.page < content.pages.size() ? fmt::format("step-{}", content.pages[line.page].number)
                                                        : std::string("account"),
                       escaped_markup(line.words));
  return out + "</div></section>\n";
}

/// A section, or nothing.
std::string job_section(const BookContent& content, const std::string& title) {
  if (content.job.empty()) return {};
  std::string out = "<section id=\"job\"><h2>" + title + "</h2><div class=\"contents\">\n";
  for (const ContentsLine& line : content.job)
    out += fmt::format("<p{}>{}</p>\n", line.heading ? " class=\"heading\"" : "", escaped_markup(line.words));
  return out + "</div></section>\n";
}

std::string account_section(const BookContent& content, const std::string& title) {
  std::string out = "<section id=\"account\"><h2>" + title + "</h2>\n";
  for (const ContentsLine& line : content.account)
    out += fmt::format("<{0}>{1}</{0}>\n", line.heading ? "h3" : "p", escaped_markup(line.words));
  return out + "</section>\n";
}

/// The box of the parts of a step.
std::string parts_box(const BookPage& page, const Illustrator& illustrator) {
  if (page.box.empty()) return {};
  std::string out = "<div class=\"box\">";
  for (const BoxEntry& entry : page.box)
    out += fmt::format("<div>{}{}{} ×</div>", plain_img(illustrator.scene(entry.picture, illustrator.style().box), ""),
                       badge(entry.item), entry.count);
  return out + "</div>";
}

std::string step_page(const BookPage& page, const StepPictures& pictures, const std::string& box,
                      const BookWords& words, bool disassembly) {
  std::string out =
      fmt::format("<section class=\"page\" id=\"step-{}\"><div class=\"head\"><span>{}</span><span>{}</span></div>\n",
                  page.number, escaped_markup(page.chapter),
                  escaped_markup(fmt::format(fmt::runtime(words.label("step {} of {}")), page.numbers(), page.count)));
  for (std::size_t other = page.number + 1; other <= page.last; ++other)
    out += fmt::format("<a id=\"step-{}\"></a>", other);
  std::string what;
  for (const auto& [item, name] : page.moving)
    what += fmt::format("<div class=\"what\">{}{}</div>", badge(item), escaped_markup(name));
  std::string motions;
  for (const std::string& motion : page.motions)
    motions += fmt::format("<p class=\"motion\">{}</p>", escaped_markup(motion));
  for (const std::string& note : page.own_notes)
    motions += fmt::format("<p class=\"own\">{}</p>", escaped_markup(note));
  const std::string caption = caption_of(pictures, words);
  out += fmt::format("<div class=\"step\"><div>{}{}{}</div>\n", box, img(pictures.apart, "the motion of this step"),
                     caption.empty() ? "" : fmt::format("<p class=\"soft\">{}</p>", escaped_markup(caption)));
  out += fmt::format(
      "<div><div class=\"number\">{}</div><div class=\"do\">{}: {}</div>{}{}", page.numbers(),
      escaped_markup(page.verb), what,
      motions + (page.warning.empty() ? "" : "<p class=\"forced\">" + escaped_markup(page.warning) + "</p>"),
      facts_list(page.facts));
  out += fmt::format("<div class=\"after\"><p>{}</p>{}</div></div></div></section>\n",
                     escaped_markup(words.label(disassembly ? "before" : "after")),
                     img(pictures.placed, disassembly ? "before this step" : "after this step"));
  return out;
}

}  // namespace

std::string book_html(const Plan& plan, const Assembly& assembly, const BookOptions& options) {
  const Illustrator illustrator(assembly, options.frame.up);
  const BookWords words(options.language, options.phrases);
  const BookContent content = book_content(plan, assembly, options, illustrator.shapes());
  const BookPictures fronts = front_pictures(plan, assembly, illustrator, content.numbers);

  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src "
      "data:\">\n<link rel=\"icon\" href=\"data:,\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n",
      escaped_markup(words.language()), escaped_markup(content.title), book_style());
  const auto label = [&](const char* english) { return escaped_markup(words.label(english)); };
  std::string warnings;
  for (const std::string& w : content.warnings)
    warnings += fmt::format("<p class=\"warning\">{}</p>", escaped_markup(w));
  out += fmt::format("<section><h1>{}</h1><p class=\"soft\">{}</p>{}\n<div class=\"title\">{}{}</div>{}</section>\n",
                     escaped_markup(content.title), escaped_markup(content.subtitle), warnings,
                     img(fronts.whole, "the assembly"), img(fronts.exploded, "the assembly, exploded"),
                     facts_list(content.facts));
  out += contents_list(content, label("Contents"));
  out += "<section><h2>" + label("Bill of materials") + "</h2>";
  if (!content.base.empty()) out += fmt::format("<p class=\"soft\">{}</p>", escaped_markup(content.base));
  out += "<div class=\"items\">\n";
  for (const BookItem& item : content.items) {
    const std::string names = fmt::format("{}", fmt::join(item.names, ", "));
    out += fmt::format(
        "<div class=\"item\"><span class=\"count\">{} ×</span>{}{}<div><strong>{}</strong></div>{}"
        "<div class=\"soft\">{}</div></div>\n",
        item.names.size(), badge(item.number),
        plain_img(illustrator.scene(item.picture, illustrator.style().item), item.name), escaped_markup(item.name),
        item.names.size() > 1 ? fmt::format("<div class=\"soft\">{}</div>", escaped_markup(names)) : "",
        escaped_markup(item.size));
  }
  out += "</div></section>\n" + job_section(content, label("Fasteners and tools"));
  std::size_t done = 0;
  for (const BookPage& page : content.pages) {
    options.on_page(++done, content.pages.size());
    const StepPictures pictures = illustrator.step(*page.step, options.disassembly, 1, content.numbers, page.held);
    out += step_page(page, pictures, parts_box(page, illustrator), words, options.disassembly);
  }
  return out + account_section(content, label("What was checked")) + "</body>\n</html>\n";
}

}  // namespace dismantle

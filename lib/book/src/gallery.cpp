// Every different part with what it is taken for, and the line that corrects it.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <tuple>

#include "canvas.h"
#include "dismantle/book/book.h"
#include "dismantle/plan_io/base64.h"
#include "dismantle/plan_io/markup.h"

namespace dismantle {
namespace {

/// Parts of one shape that are taken for the same.
struct Card {
  std::vector<std::size_t> parts;
  PartKind kind;
};

const char* gallery_style() {
  return R"(
body { margin: 0; padding: 20px 26px; background: #eef0f3; color: #20242c; font: 14px/1.4 system-ui, "DejaVu Sans", sans-serif; }
h1 { font-size: 26px; margin: 0; overflow-wrap: anywhere; } h2 { font-size: 18px; margin: 22px 0 8px; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(250px, 1fr)); gap: 12px; }
.card { background: #fff; border: 1px solid #d7dce3; border-radius: 6px; padding: 10px; overflow-wrap: anywhere; break-inside: avoid; }
.unsure { border-color: #c2410c; } .unsure .sure { color: #c2410c; font-weight: 600; }
img { display: block; margin: 0 auto; max-width: 100%; height: auto; } p { margin: 4px 0; } .soft { color: #667085; font-size: 13px; }
.count { float: right; font-weight: 600; } pre { background: #f4f5f7; padding: 6px; margin: 6px 0 0; font-size: 12px; white-space: pre-wrap; user-select: all; }
)";
}

std::vector<Card> cards_of(const Assembly& assembly, const std::vector<geometry::ShapePlacement>& shapes) {
  std::vector<Card> out;
  std::vector<std::size_t> shape;  // by card
  for (std::size_t i = 0; i < assembly.parts.size(); ++i) {
    const PartKind kind = assembly.parts[i].kind.value_or(PartKind{"other"});
    std::size_t at = 0;
    while (at < out.size() && !(shape[at] == shapes[i].original && out[at].kind == kind)) ++at;
    if (at == out.size()) out.push_back({{}, kind}), shape.push_back(shapes[i].original);
    out[at].parts.push_back(i);
  }
  return out;
}

/// Names of just these parts, with * for any end if they have the same begin and no other part has it.
std::vector<std::string> patterns_of(const Assembly& assembly, const std::vector<std::size_t>& parts) {
  std::vector<std::string> names;
  for (const std::size_t part : parts) names.push_back(assembly.parts[part].name);
  std::string begin = names.front();
  for (const std::string& name : names)
    while (!name.starts_with(begin)) begin.pop_back();
  const auto has_it = [&](const Part& part) { return part.name.starts_with(begin); };
  const auto count = static_cast<std::size_t>(std::ranges::count_if(assembly.parts, has_it));
  if (names.size() == 1 || count != names.size() || begin.empty()) return names;
  return {begin + "*"};
}

/// As in a configuration; what is stated may be changed there.
std::string yaml_of(const Assembly& assembly, const Card& card) {
  const auto quoted = [](const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  const std::string::size_type by = card.kind.kind == "screw" ? card.kind.size.find('x') : std::string::npos;
  std::string what = "kind: " + card.kind.kind;
  if (!card.kind.size.empty()) what += ", size: " + quoted(card.kind.size.substr(0, by));
  if (by != std::string::npos) what += ", length: " + card.kind.size.substr(by + 1);
  std::string out = "parts:\n";
  for (const std::string& pattern : patterns_of(assembly, card.parts))
    out += fmt::format("  {}: {{{}}}\n", quoted(pattern), what);
  return out;
}

std::string card_html(const Assembly& assembly, const Illustrator& illustrator, const Card& card) {
  constexpr double sure = 0.75;
  const Picture picture = illustrator.scene({{card.parts.front(), Pose{}}}, illustrator.style().item);
  std::string names;
  for (std::size_t i = 0; i < card.parts.size() && i < 3; ++i)
    names += (i > 0 ? ", " : "") + assembly.parts[card.parts[i]].name;
  if (card.parts.size() > 3) names += fmt::format(" and {} more", card.parts.size() - 3);
  const bool unsure = !card.kind.stated && card.kind.confidence < sure && card.kind.kind != "other";
  return fmt::format(
      "<div class=\"card{}\"><span class=\"count\">{} ×</span><strong>{}{}</strong>"
      "<img width=\"{}\" height=\"{}\" alt=\"\" src=\"data:image/png;base64,{}\">"
      "<p>{}</p><p class=\"sure\">{}</p><p class=\"soft\">{}</p><pre>{}</pre></div>\n",
      unsure ? " unsure" : "", card.parts.size(), escaped_markup(card.kind.kind),
      card.kind.size.empty() ? "" : " " + escaped_markup(card.kind.size), picture.image.width, picture.image.height,
      base64(png_of(picture)), escaped_markup(names),
      card.kind.stated            ? std::string("stated")
      : card.kind.kind != "other" ? fmt::format("{:.0f} % sure", 100 * card.kind.confidence)
                                  : std::string("not recognised"),
      escaped_markup(card.kind.reason), escaped_markup(yaml_of(assembly, card)));
}

}  // namespace

std::string kinds_html(const Assembly& assembly, const std::vector<std::string>& order, const Eigen::Vector3d& up,
                       const std::function<void()>& on_part) {
  const Illustrator illustrator(assembly, up);
  std::vector<Card> cards = cards_of(assembly, illustrator.shapes());
  const auto rank = [&](const Card& card) { return std::ranges::find(order, card.kind.kind) - order.begin(); };
  std::ranges::stable_sort(cards, {}, [&](const Card& card) {
    return std::tuple(rank(card), card.kind.stated ? 1.0 : card.kind.confidence, card.kind.size);
  });
  const std::string title = "Kinds of parts: " + assembly.source;
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; img-src "
      "data:\">\n<link rel=\"icon\" href=\"data:,\">\n<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n"
      "<h1>{0}</h1>\n<p class=\"soft\">{2} parts, {3} of them different. Of each kind, the least sure come first. To "
      "correct one, change its lines and put them into the configuration.</p>\n",
      escaped_markup(title), gallery_style(), assembly.parts.size(), cards.size());
  for (std::size_t i = 0; i < cards.size(); ++i) {
    on_part();
    if (i == 0 || cards[i].kind.kind != cards[i - 1].kind.kind)
      out += fmt::format("{}<h2>{}</h2>\n<div class=\"cards\">\n", i == 0 ? "" : "</div>\n",
                         escaped_markup(cards[i].kind.kind));
    out += card_html(assembly, illustrator, cards[i]);
  }
  return out + "</div>\n</body>\n</html>\n";
}

}  // namespace dismantle

#include <fmt/format.h>

#include "dismantle/plan_io/markup.h"
#include "report/plot.h"

namespace dismantle::bench {
namespace {

std::string_view report_style() {
  return R"(
:root { color-scheme: light dark; --line: #8884; --soft: #8881; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1200px; margin: 0 auto; padding: 1rem 1.5rem; }
h2 { margin: 2rem 0 .25rem; } p.note { margin: .25rem 0 .75rem; opacity: .75; max-width: 60rem; }
.scroll { overflow: auto; max-height: 80vh; border: 1px solid var(--line); border-radius: 6px; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; width: 100%; }
th, td { padding: .3rem .6rem; text-align: left; white-space: nowrap; border-bottom: 1px solid var(--line); }
td:last-child { max-width: 40rem; overflow: hidden; text-overflow: ellipsis; }
td.n, th.n { text-align: right; } tr:hover td { background: var(--soft); }
th { position: sticky; top: 0; background: Canvas; } th button { all: unset; cursor: pointer; font-weight: 600; }
th button:focus-visible { outline: 2px solid; } th[aria-sort=ascending] button::after { content: " \2191"; }
th[aria-sort=descending] button::after { content: " \2193"; }
input { font: inherit; padding: .3rem .5rem; margin: 0 0 .5rem; width: 20rem; max-width: 100%; }
svg { max-width: 760px; width: 100%; height: auto; } svg text { font: 12px system-ui, sans-serif; fill: currentColor; }
.grid { stroke: var(--line); } .curve { fill: none; stroke-width: 2.2; }
)";
}

std::string_view report_script() {
  return R"(
for (const table of document.querySelectorAll('table')) {
  const body = table.tBodies[0];
  table.tHead.rows[0].querySelectorAll('button').forEach((button, column) => button.addEventListener('click', () => {
    const head = button.parentElement, down = head.getAttribute('aria-sort') === 'ascending';
    for (const other of head.parentElement.cells) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const key = row => { const cell = row.cells[column]; return 'v' in cell.dataset ? Number(cell.dataset.v) : cell.textContent; };
    const order = (a, b) => {
      const x = key(a), y = key(b);
      if (typeof x !== typeof y) return typeof x === 'number' ? -1 : 1;
      return (typeof x === 'number' ? x - y : x.localeCompare(y, 'en', {numeric: true})) * (down ? -1 : 1);
    };
    body.append(...[...body.rows].sort(order));
  }));
  const filter = document.getElementById('filter-' + table.id);
  if (filter) filter.addEventListener('input', () => {
    const words = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of body.rows) {
      const text = row.textContent.toLowerCase();
      row.hidden = !words.every(word => text.includes(word));
    }
  });
}
)";
}

bool is_number_column(const Table& table, std::size_t column) {
  for (const auto& row : table.rows)
    if (row[column].value) return true;
  return false;
}

std::string content_of(const TableCell& cell) {
  const std::string text = escaped_markup(cell.text);
  return cell.link.empty() ? text : fmt::format("<a href='{}'>{}</a>", escaped_markup(cell.link), text);
}

std::string html_of(const Table& table) {
  std::string out = fmt::format("<h2 id='{}'>{}</h2>\n<p class='note'>{}</p>\n", "about-" + table.id,
                                escaped_markup(table.title), escaped_markup(table.note));
  if (!table.remark.empty()) out += fmt::format("<p class='note'>Note: {}</p>\n", escaped_markup(table.remark));
  if (table.id == "trials")
    out +=
        "<label>Show rows with <input id='filter-trials' type='search' placeholder='words, such as: bfs "
        "timeout'></label>\n";
  out += fmt::format("<div class='scroll'><table id='{}'><thead><tr>", table.id);
  std::vector<bool> numbers;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    numbers.push_back(is_number_column(table, i));
    out +=
        fmt::format("<th{}><button>{}</button></th>", numbers[i] ? " class='n'" : "", escaped_markup(table.columns[i]));
  }
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      out += fmt::format("<td{}{}>{}</td>", numbers[i] ? " class='n'" : "",
                         row[i].value ? fmt::format(" data-v='{:.9g}'", *row[i].value) : "", content_of(row[i]));
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

}  // namespace

std::string report_html(const ReportData& data, const std::vector<Table>& tables) {
  const std::string title = escaped_markup(data.name);
  std::string out = "<!doctype html>\n<html lang='en'><head><meta charset='utf-8'>\n";
  out += "<meta name='viewport' content='width=device-width, initial-scale=1'>\n";
  out += fmt::format("<title>{} - Dismantle</title>\n<style>{}</style></head><body>\n<h1>{}</h1>\n", title,
                     report_style(), title);
  out += fmt::format("<p>{} trials of {} planners.", data.rows.size(), data.planners.size());
  for (const auto& note : data.notes) out += " " + escaped_markup(note);
  out += "</p>\n";
  for (const auto& table : tables) {
    if (table.id == "curves") out += "<h2>Success over time</h2>\n" + svg_of(curves_of(data));
    if (table.id == "progress" && !table.rows.empty())
      out += "<h2>Progress over time</h2>\n" + svg_of(progress_of(data), "", {"Share of parts out over time", " s"});
    if (table.id == "searches" && !table.rows.empty())
      out +=
          "<h2>Progress of searches</h2>\n" + svg_of(searches_of(data), "", {"Way of the best state over effort", ""});
    out += html_of(table);
  }
  return out + fmt::format("<script>{}</script>\n</body></html>\n", report_script());
}

}  // namespace dismantle::bench

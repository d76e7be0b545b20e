#include <fmt/format.h>

#include <algorithm>

#include "dismantle/bench/report.h"

namespace dismantle::bench {
namespace {

/// Columns on a terminal: continuation bytes of UTF-8 characters do not count.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string headline(const ReportData& data) {
  return fmt::format("{}: {} trials, {} planners", data.name, data.rows.size(), data.planners.size());
}

std::string escaped_markdown(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '\\') out += '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  return out;
}

std::string escaped_csv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

}  // namespace

std::string report_text(const ReportData& data, const std::vector<Table>& tables) {
  std::string out = headline(data) + "\n";
  for (const auto& note : data.notes) out += "note: " + note + "\n";
  for (const auto& table : tables) {
    std::vector<std::size_t> widths;
    for (const auto& column : table.columns) widths.push_back(width_of(column));
    for (const auto& row : table.rows)
      for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width_of(row[i].text));
    const auto line = [&](const auto& cell) {
      std::string text;
      for (std::size_t i = 0; i < widths.size(); ++i)
        text += cell(i) + std::string(widths[i] - width_of(cell(i)) + 2, ' ');
      while (!text.empty() && text.back() == ' ') text.pop_back();
      return text + "\n";
    };
    out += "\n" + table.title + "\n" + line([&](std::size_t i) { return table.columns[i]; });
    for (const auto& row : table.rows) out += line([&](std::size_t i) { return row[i].text; });
    if (!table.remark.empty()) out += "note: " + table.remark + "\n";
  }
  return out;
}

std::string report_markdown(const ReportData& data, const std::vector<Table>& tables) {
  std::string out = "# " + escaped_markdown(headline(data)) + "\n";
  for (const auto& note : data.notes) out += "\n> " + escaped_markdown(note) + "\n";
  for (const auto& table : tables) {
    out += fmt::format("\n## {}\n\n{}\n\n", table.title, escaped_markdown(table.note));
    if (!table.remark.empty()) out += "> " + escaped_markdown(table.remark) + "\n\n";
    for (const auto& column : table.columns) out += "| " + escaped_markdown(column) + " ";
    out += "|\n";
    for (std::size_t i = 0; i < table.columns.size(); ++i) out += "|---";
    out += "|\n";
    for (const auto& row : table.rows) {
      for (const auto& cell : row) out += "| " + escaped_markdown(cell.text) + " ";
      out += "|\n";
    }
  }
  return out;
}

std::string report_csv(const std::vector<Table>& tables) {
  std::string out;
  for (const auto& table : tables) {
    if (!out.empty()) out += "\r\n";
    const auto line = [&](const auto& cell) {
      for (std::size_t i = 0; i < table.columns.size(); ++i) out += (i == 0 ? "" : ",") + escaped_csv(cell(i));
      out += "\r\n";
    };
    line([&](std::size_t i) { return table.columns[i]; });
    for (const auto& row : table.rows) line([&](std::size_t i) { return row[i].text; });
  }
  return out;
}

}  // namespace dismantle::bench

#include <fmt/format.h>

#include <sstream>

#include "completion.h"

namespace dismantle::app {
namespace {

/// Escapes text for troff: backslashes, hyphens, and lines that would be requests.
std::string roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_begins = c == '\n';
  }
  return out;
}

std::string option_text(const CommandOption& option, bool is_argument) {
  std::string names;
  for (const std::string& name : option.names)
    names += fmt::format("{}\\f{}{}\\fR", names.empty() ? "" : ", ", is_argument ? 'I' : 'B', roff(name));
  if (!option.value.empty() && !is_argument) names += fmt::format(" \\fI{}\\fR", roff(option.value));
  return fmt::format(".TP\n{}\n{}\n", names, roff(option.help));
}

/// Footers contain examples, so their line breaks are kept.
std::string footer_text(const std::string& footer) {
  if (footer.empty()) return "";
  return ".PP\n.nf\n" + roff(footer) + "\n.fi\n";
}

std::string command_text(const CommandNode& node) {
  std::string out = fmt::format(".SS {}", roff(node.name()));
  for (const CommandOption& argument : node.arguments) out += " " + roff(argument.names.front());
  out += fmt::format("\n{}{}\n", roff(node.help), node.help.ends_with('?') ? "" : ".");
  for (const CommandOption& argument : node.arguments) out += option_text(argument, true);
  for (const CommandOption& option : node.options)
    if (option.names.back() != "--help") out += option_text(option, false);
  return out + footer_text(node.footer);
}

}  // namespace

std::string manual_page(const CommandNode& root) {
  const std::string program = root.path.back();
  std::string out = fmt::format(".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", program, program,
                                DISMANTLE_VERSION, program, roff(root.help));
  out += fmt::format(".SH SYNOPSIS\n.B {}\n.I COMMAND\n[\\fIOPTION\\fR]...\n.br\n.B {} \\fICOMMAND\\fR \\-\\-help\n",
                     program, program);
  out += ".SH OPTIONS\n";
  for (const CommandOption& option : root.options) out += option_text(option, false);
  out += footer_text(root.footer);
  out += ".SH COMMANDS\n";
  for (const CommandNode* node : all_of(root))
    if (node->commands.empty() && node != &root) out += command_text(*node);
  out +=
      ".SH ENVIRONMENT\n"
      ".TP\n\\fBDISMANTLE_PLUGIN_PATH\\fR\nFolders in which plugins are searched, separated by colons.\n"
      ".TP\n\\fBNO_COLOR\\fR\nIf it is set and not empty, no colours are written, on terminals either.\n";
  return out;
}

}  // namespace dismantle::app

// The kinds of the parts of an assembly, equal ones together.
#include "check/kinds.h"

#include <fmt/format.h>

#include <algorithm>

#include "dismantle/fasteners/kinds.h"

namespace dismantle {

std::vector<CheckedKind> checked_kinds(const Assembly& assembly) {
  std::vector<CheckedKind> out;
  for (const Part& part : assembly.parts) {
    if (!part.kind) continue;
    const auto same = std::find_if(out.begin(), out.end(), [&](const CheckedKind& k) { return k.kind == *part.kind; });
    if (same == out.end())
      out.push_back({{part.name}, *part.kind});
    else
      same->parts.push_back(part.name);
  }
  const auto rank = [](const CheckedKind& k) {
    return fasteners::kind_from_string(k.kind.kind).value_or(fasteners::Kind::other);
  };
  std::stable_sort(out.begin(), out.end(), [&](const CheckedKind& a, const CheckedKind& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.kind.size < b.kind.size;
  });
  return out;
}

std::string kinds_text(const std::vector<CheckedKind>& kinds, bool verbose) {
  std::string out;
  std::size_t others = 0;
  std::vector<CheckedKind> lines;  // alike but for the reasons
  for (const CheckedKind& k : kinds) {
    if (k.kind.kind == "other") {
      others += k.parts.size();
      continue;
    }
    const auto same = std::find_if(lines.begin(), lines.end(), [&](const CheckedKind& line) {
      return !verbose && line.kind.kind == k.kind.kind && line.kind.size == k.kind.size &&
             line.kind.stated == k.kind.stated;
    });
    if (same == lines.end()) {
      lines.push_back(k);
      continue;
    }
    same->kind.confidence = std::min(same->kind.confidence, k.kind.confidence);
    same->parts.insert(same->parts.end(), k.parts.begin(), k.parts.end());
  }
  for (const CheckedKind& k : lines) {
    out += fmt::format("  {}x {}{}{}, {}: '{}'{}\n", k.parts.size(), k.kind.kind, k.kind.size.empty() ? "" : " ",
                       k.kind.size, k.kind.stated ? "stated" : fmt::format("{:.0f} % sure", 100 * k.kind.confidence),
                       k.parts.front(), k.parts.size() > 1 ? ", ..." : "");
    if (verbose || k.kind.reason.find("disagree") != std::string::npos) out += fmt::format("      {}\n", k.kind.reason);
  }
  if (out.empty()) return out;
  if (others > 0) out += fmt::format("  {}x other\n", others);
  return "kinds of parts:\n" + out;
}

}  // namespace dismantle

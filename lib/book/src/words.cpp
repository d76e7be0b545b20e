#include "words.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "dismantle/book/book.h"
#include "dismantle/errors.h"

namespace dismantle {
namespace {

bool in_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || (static_cast<unsigned char>(c) & 0x80) != 0;
}

}  // namespace

BookWords::BookWords(std::string language, std::map<std::string, std::string> phrases)
    : language_(std::move(language)), phrases_(std::move(phrases)) {
  for (const auto& [english, other] : phrases_) {
    if (!same_places(english, other))
      throw Error("the translation of '" + english + "' needs as many places {} as it: '" + other + "'");
    if (!english.empty() && english.find('{') == std::string::npos) longest_first_.push_back(english);
  }
  std::ranges::stable_sort(longest_first_, std::greater{}, &std::string::size);
}

const std::string& BookWords::label(const std::string& english) const {
  const auto known = phrases_.find(english);
  return known == phrases_.end() ? english : known->second;
}

std::string BookWords::text(const std::string& english) const {
  if (phrases_.empty()) return english;
  std::string out;
  for (std::size_t at = 0; at < english.size();) {
    if (english[at] == '\'') {  // a name
      const std::size_t end = std::min(english.find('\'', at + 1), english.size() - 1);
      out.append(english, at, end + 1 - at);
      at = end + 1;
      continue;
    }
    const bool begins = at == 0 || !in_word(english[at - 1]);
    const auto fits = [&](const std::string& phrase) {
      const std::size_t end = at + phrase.size();
      return english.compare(at, phrase.size(), phrase) == 0 &&
             (end >= english.size() || !in_word(english[end]) || !in_word(phrase.back()));
    };
    const auto found = begins ? std::ranges::find_if(longest_first_, fits) : longest_first_.end();
    if (found == longest_first_.end()) {
      out += english[at++];
      continue;
    }
    out += phrases_.at(*found);
    at += found->size();
  }
  return out;
}

const std::vector<std::string>& book_labels() {
  static const std::vector<std::string> labels = {
      "How to put it together",
      "How to take it apart",
      "Contents",
      "Bill of materials",
      "Fasteners and tools",
      "The whole assembly",
      "Assembly",
      "Sub-assembly {}",
      "{} ({} parts)",
      "step {} of {}",
      "Put in",
      "Take out",
      "Move aside",
      "Move back",
      "before",
      "after",
      "parts",
      "steps",
      "size",
      "directions",
      "units",
      "checked",
      "plan",
      "made by",
      "revision",
      "lies",
      "base",
      "of",
      "how far",
      "because",
      "you can",
      "touches",
      "note",
      "hold",
      "tool",
      "direction",
      "distance",
      "length of the path",
      "instance",
      "seen {}",
      "drawn further apart than needed",
      "right is {}, up is {}, the front is at {}",
      "every motion, with parts that overlap by at most {} more than when assembled",
      "those of the input, which names none",
      "it is apart already: nothing has to move",
      "Not verified: {}.",
      "Not verified: in these steps parts cut into others: {}.",
      "{} shapes",
      "Fasteners",
      "Tools",
      "What was checked",
      "Why this order",
      "Checked",
      "Not checked",
      "Assumed",
      "order"};
  return labels;
}

}  // namespace dismantle

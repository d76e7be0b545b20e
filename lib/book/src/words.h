/// The language of a book: English, or what a file says instead.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace dismantle {

/// Texts of a book by their English form.
class BookWords {
 public:
  BookWords() = default;  ///< English
  /// `language`: as in HTML ("de"). `phrases`: English text, what stands there instead.
  /// @throws Error for a translation with other places `{}` than the English text.
  BookWords(std::string language, std::map<std::string, std::string> phrases);

  const std::string& language() const { return language_; }
  /// A fixed text of the book, with its places `{}`.
  const std::string& label(const std::string& english) const;
  /// A sentence: each longest phrase that is known, as whole words. What stands between quotes '...' is a name and
  /// stays.
  std::string text(const std::string& english) const;

 private:
  std::string language_ = "en";
  std::map<std::string, std::string> phrases_;
  std::vector<std::string> longest_first_;
};

/// All fixed texts of a book, for writers of language files.
const std::vector<std::string>& book_labels();

}  // namespace dismantle

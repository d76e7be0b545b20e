// Languages of a book.
#include "words.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "dismantle/book/book.h"
#include "dismantle/errors.h"

namespace dismantle {
namespace {

TEST(BookWords, PhrasesAreWholeWordsAndNamesStay) {
  const BookWords words("de", {{"up", "hoch"}, {"put in", "einbauen"}, {"put", "legen"}, {"step {} of {}", "{} / {}"}});
  EXPECT_EQ(words.text("put in 'put up' up (+Z), upper"), "einbauen 'put up' hoch (+Z), upper");
  EXPECT_EQ(words.text("put"), "legen");
  EXPECT_EQ(words.text("put_in, up_to, pile_up"), "put_in, up_to, pile_up") << "ids of checks and parameters";
  EXPECT_EQ(words.text("an open ' quote up"), "an open ' quote up") << "to the end";
  EXPECT_EQ(words.label("step {} of {}"), "{} / {}");
  EXPECT_EQ(words.label("Contents"), "Contents") << "what the file lacks stays English";
  EXPECT_EQ(BookWords().text("put in 'x' up"), "put in 'x' up");
}

TEST(BookWords, ATranslationHasThePlacesOfItsText) {
  for (const char* other : {"{}", "{} {} {}", "{0} {}", "{} { }", "} {} {}"})
    EXPECT_THROW(BookWords("de", {{"step {} of {}", other}}), Error) << other;
}

// Law: the languages that are installed have all fixed texts of a book.
TEST(BookWords, TheLanguagesOfTheProjectAreWhole) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(DISMANTLE_LANGUAGES))) {
    ++files;
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    for (const std::string& label : book_labels()) {
      const bool plain = text.str().find("\n  " + label + ": ") != std::string::npos;
      EXPECT_TRUE(plain || text.str().find("\n  \"" + label + "\": ") != std::string::npos)
          << entry.path() << " lacks '" << label << "'";
    }
  }
  EXPECT_GE(files, 2u);
}

}  // namespace
}  // namespace dismantle

/// What stands in a book, before it is HTML or PDF.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dismantle/book/book.h"
#include "dismantle/plan_io/input_frame.h"
#include "illustrator.h"

namespace dismantle {

using Facts = std::vector<std::pair<std::string, std::string>>;  // name, value

/// Parts of one shape.
struct BookItem {
  std::size_t number = 0;  ///< from 1
  std::string name;        ///< of the first, or what all names begin with
  std::vector<std::size_t> parts;
  std::string size;  ///< of the box, in the unit
};

struct BookPage {
  std::string chapter;  ///< "Sub-assembly A"
  bool chapter_begins = false;
  std::size_t number = 0, count = 0;                        ///< of the pages of steps
  std::vector<std::pair<std::size_t, std::string>> moving;  ///< item number, "2 x bolt"
  std::string verb;                                         ///< "Put in", "Take out", "Move aside"
  std::vector<std::string> motions;                         ///< a line for each mover
  std::string warning;                                      ///< the step is forced; else empty
  Facts facts;
  const BookStep* step = nullptr;
};

struct BookContent {
  std::string title, subtitle;
  Facts facts;
  std::vector<std::string> warnings;
  std::vector<BookItem> items;
  std::vector<BookChapter> chapters;
  std::vector<BookPage> pages;  ///< `step` points into `chapters`
};

/// @throws InputError as book_html().
BookContent book_content(const Plan& plan, const Assembly& assembly, const BookOptions& options,
                         const std::vector<ShapePlacement>& shapes);

}  // namespace dismantle

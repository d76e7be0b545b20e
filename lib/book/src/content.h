/// The content of a book, independent of HTML and PDF.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "dismantle/book/book.h"
#include "dismantle/plan_io/input_frame.h"
#include "illustrator.h"

namespace dismantle {

using Facts = std::vector<std::pair<std::string, std::string>>;  // name, value

/// What the book puts in or takes out, and counts as one: parts of one shape, or a product that is kept together.
struct BookItem {
  std::size_t number = 0;           ///< from 1
  std::string name;                 ///< common beginning of all names, or the first name, or the product
  std::string label;                ///< on the pages of steps: the name, or what tells it from items of that name
  std::vector<std::string> names;   ///< of the parts, or of the uses of the product
  std::vector<PlacedPart> picture;  ///< one part, or the bodies of one product
  std::string size;                 ///< of the bounding box, with unit; before it what the part is, if that is known
};

/// A line of the table of contents: a step, or the name of what the steps after it build.
struct ContentsLine {
  std::string words;
  std::size_t page = 0;  ///< index into BookContent::pages
  bool heading = false;
};

/// A picture in the box of the parts of a step.
struct BoxEntry {
  std::size_t item = 0;  ///< number; 0: a sub-assembly, or what is no item
  std::size_t count = 1;
  std::vector<PlacedPart> picture;  ///< one of them
};

struct BookPage {
  std::string chapter;  ///< "Sub-assembly A"
  bool chapter_begins = false;
  std::size_t number = 0, count = 0;                        ///< of the step, of all steps of the plan
  std::size_t last = 0;                                     ///< number of the last of several equal steps
  std::vector<std::pair<std::size_t, std::string>> moving;  ///< item number, "2 x bolt"
  std::string verb;                                         ///< "Put in", "Take out", "Move aside"
  std::vector<std::string> motions;                         ///< one line per mover
  std::vector<std::string> own_notes;                       ///< of the reader of the plan
  std::string warning;                                      ///< not empty if the step is forced
  Facts facts;
  const BookStep* step = nullptr;
  std::vector<BoxEntry> box;        ///< what the step puts in or takes out
  std::vector<std::size_t> held{};  ///< parts to hold

  /// "3", "3–8"
  std::string numbers() const;
};

struct BookContent {
  std::string title, subtitle;
  Facts facts;
  std::vector<std::string> warnings;
  std::vector<BookItem> items;
  std::string base;                    ///< what the book leaves together and does not list, in words; empty: nothing
  std::vector<ContentsLine> job;       ///< fasteners and tools of the whole job, without pages; empty: there are none
  std::vector<ContentsLine> contents;  ///< empty: too few pages for it; a page that is none of `pages`: `account`
  std::vector<ContentsLine> account;   ///< what was checked, not checked, assumed, and why this order; without pages
  std::vector<BookChapter> chapters;
  PartNumbers numbers;          ///< by part: of its item
  std::vector<BookPage> pages;  ///< by number; `step` points into `chapters`
};

/// @throws InputError as book_html().
BookContent book_content(const Plan& plan, const Assembly& assembly, const BookOptions& options,
                         const std::vector<geometry::ShapePlacement>& shapes);

}  // namespace dismantle

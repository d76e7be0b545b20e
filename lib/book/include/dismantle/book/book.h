/// Printed instructions: a title page, the bill of materials, a page per step.
#pragma once

#include <functional>
#include <string>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle {

struct BookOptions {
  InputFrame frame;          ///< unit and up axis of the input
  bool disassembly = false;  ///< how to take it apart; else how to put it together
  std::string title;         ///< empty: the name of the plan's source, without the ending of a CAD file
  /// Called before each page with its number (from 1) and how many there are. It may throw to stop.
  std::function<void(std::size_t page, std::size_t pages)> on_page = [](std::size_t, std::size_t) {};
};

/// One self-contained HTML file with pictures as PNG, made for paper too (a page per step). Without scripts.
/// @throws InputError when the plan moves a part that the assembly does not have, or has no steps.
DISMANTLE_API std::string book_html(const Plan& plan, const Assembly& assembly, const BookOptions& options);

/// The same as PDF, A4 landscape. The bytes depend on the fonts that are installed.
/// @throws InputError as book_html(). @throws Error when the PDF library fails.
DISMANTLE_API std::string book_pdf(const Plan& plan, const Assembly& assembly, const BookOptions& options);

/// PNG of two parts as assembled, from above in front: `marked`, the smaller one best, in orange through what is before
/// it, and a ring around the place `at` (input coordinates). What is further from `marked` than it is large may lie
/// outside the picture. @throws std::out_of_range when the assembly has no such part.
DISMANTLE_API std::string pair_png(const Assembly& assembly, PartId other, PartId marked, const Eigen::Vector3d& at,
                                   bool y_up);

/// The functions above for programs that load the library when they need it: pango and what it depends on would cost a
/// program that is linked to them milliseconds at every start.
struct BookLibrary {
  std::string (*html)(const Plan&, const Assembly&, const BookOptions&);
  std::string (*pdf)(const Plan&, const Assembly&, const BookOptions&);
  std::string (*pair_png)(const Assembly&, PartId, PartId, const Eigen::Vector3d&, bool);
};
extern "C" DISMANTLE_API const BookLibrary* dismantle_book_library();

}  // namespace dismantle

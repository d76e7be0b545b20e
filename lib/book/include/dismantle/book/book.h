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
  bool disassembly = false;  ///< true: instructions for disassembly; false: for assembly
  std::string title;         ///< empty: the name of the plan's source, without the extension of a CAD file
  /// Called before each page with its number (from 1) and the number of pages. It may throw to stop.
  std::function<void(std::size_t page, std::size_t pages)> on_page = [](std::size_t, std::size_t) {};
};

/// One self-contained HTML file with PNG pictures and without scripts. It can be printed, a page per step.
/// @throws InputError when the plan moves a part that the assembly does not have, or has no steps.
DISMANTLE_API std::string book_html(const Plan& plan, const Assembly& assembly, const BookOptions& options);

/// The same as PDF, A4 landscape. The bytes depend on the installed fonts.
/// @throws InputError as book_html(). @throws Error when the PDF library fails.
DISMANTLE_API std::string book_pdf(const Plan& plan, const Assembly& assembly, const BookOptions& options);

/// PNG of two parts as assembled, seen from the front and above. `marked` (preferably the smaller part) is drawn in
/// orange, also where it is hidden, with a ring around the place `at` (input coordinates). Places further from `marked`
/// than its size may lie outside the picture. @throws std::out_of_range when the assembly has no such part.
DISMANTLE_API std::string pair_png(const Assembly& assembly, PartId other, PartId marked, const Eigen::Vector3d& at,
                                   const Eigen::Vector3d& up);

/// The functions above for programs that load the library on demand: linking pango and its dependencies would delay
/// every start of the program by milliseconds.
struct BookLibrary {
  std::string (*html)(const Plan&, const Assembly&, const BookOptions&);
  std::string (*pdf)(const Plan&, const Assembly&, const BookOptions&);
  std::string (*pair_png)(const Assembly&, PartId, PartId, const Eigen::Vector3d&, const Eigen::Vector3d&);
};
extern "C" DISMANTLE_API const BookLibrary* dismantle_book_library();

}  // namespace dismantle

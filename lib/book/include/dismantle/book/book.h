/// Printed instructions: a title page, the bill of materials, a page per step.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dismantle/assembly.h"
#include "dismantle/export.h"
#include "dismantle/plan.h"
#include "dismantle/plan_io/input_frame.h"

namespace dismantle {

/// What somebody says of a step.
struct BookNote {
  std::vector<std::string> parts;  ///< the parts that the step moves, in any order
  std::string text;
};

/// Has a translation as many places `{}` as the English text, and no other braces?
inline bool same_places(const std::string& english, const std::string& other) {
  const auto count = [](const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + what.size())) ++n;
    return n;
  };
  const std::size_t places = count(other, "{}");
  return places == count(english, "{}") && count(other, "{") == places && count(other, "}") == places;
}

struct BookOptions {
  InputFrame frame;               ///< unit and up axis of the input
  bool disassembly = false;       ///< true: instructions for disassembly; false: for assembly
  std::string title;              ///< empty: the name of the plan's source, without the extension of a CAD file
  std::string revision;           ///< of the instructions; empty: none is stated
  std::vector<BookNote> notes{};  ///< on steps; those of other steps are not printed
  std::string language = "en";    ///< as in HTML
  /// English text of the book, what stands there instead. Both have the same places: see same_places().
  std::map<std::string, std::string> phrases{};
  /// Called before each page with its number (from 1) and the number of pages. It may throw to stop.
  std::function<void(std::size_t page, std::size_t pages)> on_page = [](std::size_t, std::size_t) {};
};

/// One self-contained HTML file with PNG pictures and without scripts. It can be printed, a page per step.
/// @throws InputError when the plan moves a part that the assembly does not have, or has no steps.
DISMANTLE_API std::string book_html(const Plan& plan, const Assembly& assembly, const BookOptions& options);

/// The same as PDF, A4 landscape. The bytes depend on the installed fonts.
/// @throws InputError as book_html(). @throws Error when the PDF library fails.
DISMANTLE_API std::string book_pdf(const Plan& plan, const Assembly& assembly, const BookOptions& options);

struct FilmOptions {
  InputFrame frame;          ///< up axis of the input
  bool disassembly = false;  ///< true: it is taken apart
  int width = 720, height = 540;
  /// Called before each step with its place (from 1) and their number. It may throw to stop.
  std::function<void(std::size_t step, std::size_t steps)> on_step = [](std::size_t, std::size_t) {};
};

/// All steps as an animated GIF, which repeats. The same plan gives the same bytes.
/// @throws InputError as book_html(). @throws Error when the program was built without giflib.
DISMANTLE_API std::string book_gif(const Plan& plan, const Assembly& assembly, const FilmOptions& options);

/// PNG of two parts as assembled, seen from the front and above. `marked` (preferably the smaller part) is drawn in
/// orange, also where it is hidden, with a ring around the place `at` (input coordinates). Places further from `marked`
/// than its size may lie outside the picture. @throws std::out_of_range when the assembly has no such part.
DISMANTLE_API std::string pair_png(const Assembly& assembly, PartId other, PartId marked, const Eigen::Vector3d& at,
                                   const Eigen::Vector3d& up);

/// One self-contained HTML file without scripts: a picture of every different part, what it is taken for, how sure that
/// is and why, and the lines of a configuration that state it, to be corrected. `order`: of the kinds; others come
/// last. `on_part` is called before each picture; it may throw to stop.
DISMANTLE_API std::string kinds_html(const Assembly& assembly, const std::vector<std::string>& order,
                                     const Eigen::Vector3d& up, const std::function<void()>& on_part);

/// The functions above for programs that load the library on demand: linking pango and its dependencies would delay
/// every start of the program by milliseconds.
struct BookLibrary {
  std::string (*html)(const Plan&, const Assembly&, const BookOptions&);
  std::string (*pdf)(const Plan&, const Assembly&, const BookOptions&);
  std::string (*gif)(const Plan&, const Assembly&, const FilmOptions&);
  std::string (*pair_png)(const Assembly&, PartId, PartId, const Eigen::Vector3d&, const Eigen::Vector3d&);
  std::string (*kinds_html)(const Assembly&, const std::vector<std::string>&, const Eigen::Vector3d&,
                            const std::function<void()>&);
};
extern "C" DISMANTLE_API const BookLibrary* dismantle_book_library();

}  // namespace dismantle

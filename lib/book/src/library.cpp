#include "dismantle/book/book.h"

namespace dismantle {

const BookLibrary* dismantle_book_library() {
  static constexpr BookLibrary kLibrary{book_html, book_pdf, pair_png};
  return &kLibrary;
}

}  // namespace dismantle

#include "dismantle/book/book.h"

namespace dismantle {

const BookLibrary* dismantle_book_library() {
  static const BookLibrary library{book_html, book_pdf, book_gif, pair_png, kinds_html};
  return &library;
}

}  // namespace dismantle

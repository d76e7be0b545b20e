#ifdef DISMANTLE_BOOK_LIBRARY
#include "book_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "dismantle/errors.h"

namespace dismantle::app {

const BookLibrary& book_library() {
  void* library = ::dlopen(DISMANTLE_BOOK_LIBRARY, RTLD_NOW | RTLD_LOCAL);
  void* symbol = library != nullptr ? ::dlsym(library, "dismantle_book_library") : nullptr;
  if (symbol == nullptr)
    throw Error(fmt::format("pictures cannot be drawn, {}; Debian: apt-get install libpangocairo-1.0-0", ::dlerror()));
  return *reinterpret_cast<const BookLibrary* (*)()>(symbol)();
}

}  // namespace dismantle::app
#endif

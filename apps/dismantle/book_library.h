/// The library that draws pictures, loaded by the commands that need it.
#pragma once

#include "dismantle/book/book.h"

namespace dismantle::app {

/// Loads the library at the first call and keeps it loaded. @throws Error saying what to install.
const BookLibrary& book_library();

}  // namespace dismantle::app

/// The library that draws, loaded by the commands that need it.
#pragma once

#include "dismantle/book/book.h"

namespace dismantle::app {

/// Stays loaded. @throws Error saying what to install.
const BookLibrary& book_library();

}  // namespace dismantle::app

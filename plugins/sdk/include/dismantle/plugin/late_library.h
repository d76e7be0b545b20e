/// Shared libraries that are loaded when first needed.
#pragma once

#include <dlfcn.h>

#include <string>

#include "dismantle/errors.h"

namespace dismantle {

/// Loads `library`, searched for where the caller's libraries are, and returns its function `symbol`. The library stays
/// loaded. Meant for libraries that few runs use: loading one with its dependencies takes longer than planning a small
/// assembly. `Function` must be the compiled type of the function. @throws Error with the dynamic linker's message.
template <class Function>
Function* late_function(const char* library, const char* symbol) {
  void* loaded = ::dlopen(library, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* found = loaded != nullptr ? ::dlsym(loaded, symbol) : nullptr;
  if (found == nullptr) {
    const char* why = ::dlerror();
    throw Error(std::string("a part of Dismantle cannot be loaded: ") + (why != nullptr ? why : library));
  }
  return reinterpret_cast<Function*>(found);
}

}  // namespace dismantle

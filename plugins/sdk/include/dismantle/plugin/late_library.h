/// Libraries that are loaded when they are first needed.
#pragma once

#include <dlfcn.h>

#include <string>

#include "dismantle/errors.h"

namespace dismantle {

/// The function `symbol` of the shared library `library`, which is searched where the libraries of the caller are and
/// stays loaded. A library that few runs use, with all that it is linked with, takes longer to load than a small
/// assembly to plan. `Function` must be the type that it was compiled with. @throws Error with the message of the
/// dynamic linker.
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

/// The motions with which a search looks for a path.
#pragma once

namespace dismantle::path {

enum class Motion {
  translation,  ///< R3, orientation locked
  rotation,     ///< SE(3)
  automatic,    ///< one search of each kind; they take turns
};

}  // namespace dismantle::path

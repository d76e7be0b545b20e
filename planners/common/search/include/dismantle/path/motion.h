/// In which motions a search looks for a path.
#pragma once

namespace dismantle::path {

enum class Motion {
  translation,  ///< R3, orientation locked
  rotation,     ///< SE(3)
  automatic,    ///< a search of each kind, which take turns
};

}  // namespace dismantle::path

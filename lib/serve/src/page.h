/// The first page of the server.
#pragma once

namespace dismantle::serve {

extern const char* const kPage;  ///< HTML without any data

}  // namespace dismantle::serve

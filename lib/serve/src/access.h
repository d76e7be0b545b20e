/// Who may ask what: the rules of security that need no server.
#pragma once

#include <string>
#include <string_view>

namespace dismantle::serve {

/// 32 hexadecimal digits of the system's random numbers.
std::string new_token();
/// Takes the same time wherever two texts of one length differ.
bool same_token(std::string_view given, std::string_view token);
/// A browser that was led here by a foreign name (DNS rebinding) sends that name.
bool allowed_host(std::string_view host, int port);
/// The page itself, or a program, which sends no origin (an empty text).
bool allowed_origin(std::string_view origin, int port);
/// A name in the folder itself: valid UTF-8 without separators and control characters, neither hidden nor too long.
bool plain_name(std::string_view name);

}  // namespace dismantle::serve

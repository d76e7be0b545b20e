/// Shell completion scripts and the manual page, generated from the command tree.
#pragma once

#include <string>

#include "command_tree.h"

namespace dismantle::app {

std::string bash_completion(const CommandNode& root);
std::string zsh_completion(const CommandNode& root);
std::string fish_completion(const CommandNode& root);
/// troff, section 1.
std::string manual_page(const CommandNode& root);

}  // namespace dismantle::app

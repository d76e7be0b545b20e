/// Processes that a child leaves behind, wherever they have gone.
#pragma once

#include <string>

namespace dismantle::bench {

/// A variable NAME=VALUE that no other child has. Whatever a child starts has it in its environment, also what has left the
/// process group by setsid() and has another parent by now.
std::string new_mark();

/// Kills all processes of this user whose environment has the mark, until none is left.
void kill_marked(const std::string& mark);

}  // namespace dismantle::bench

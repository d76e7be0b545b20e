/// Finds and kills the processes that a child leaves behind, in any process group.
#pragma once

#include <string>

namespace dismantle::process {

/// A variable NAME=VALUE that no other child has. All descendants of a child inherit it, including those that have left
/// the process group by setsid() and have another parent by now.
std::string new_mark();

/// Kills all processes of this user whose environment has the mark, until none is left.
void kill_marked(const std::string& mark);

}  // namespace dismantle::process

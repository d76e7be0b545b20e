/// Identifies the process that runs a trial, and tells whether it is still alive.
#pragma once

#include <string>

namespace dismantle::bench {

/// Id of this machine and its current boot.
std::string this_host();
/// Process id and start time of this process, so that a later process with the same id is another owner.
std::string this_owner();
/// Only for owners on this host.
bool is_alive(const std::string& owner);
std::string cpu_model();

}  // namespace dismantle::bench

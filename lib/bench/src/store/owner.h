/// Who runs a trial, and whether they are still there.
#pragma once

#include <string>

namespace dismantle::bench {

/// Of this machine since it was booted.
std::string this_host();
/// Of this process: its id and when it began, so that a later process of the same id is somebody else.
std::string this_owner();
/// For an owner on this host.
bool is_alive(const std::string& owner);
std::string cpu_model();

}  // namespace dismantle::bench

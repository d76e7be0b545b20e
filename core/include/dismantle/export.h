/// Visibility of symbols that cross the boundary between the core and a plugin.
#pragma once
#define DISMANTLE_API __attribute__((visibility("default")))

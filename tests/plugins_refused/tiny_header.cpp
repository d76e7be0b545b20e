// The right name, but hardly any bytes behind it.
extern "C" __attribute__((visibility("default"))) const char dismantle_plugin_header[4] = {'D', 'M', 'P', 'L'};

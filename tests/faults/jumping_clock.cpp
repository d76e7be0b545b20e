// Preloaded into a program: the time of day jumps by hours between any two readings, forwards and backwards.
#include <dlfcn.h>
#include <sys/time.h>
#include <time.h>

#include <atomic>

namespace {

/// 0, 7, -7, 14, -14, ... hours.
time_t jump() {
  static std::atomic<long> readings{0};
  const long n = readings++ % 20;
  return 7 * 3600 * ((n + 1) / 2) * (n % 2 == 0 ? -1 : 1);
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* out) {
  static const auto real = reinterpret_cast<int (*)(clockid_t, timespec*)>(dlsym(RTLD_NEXT, "clock_gettime"));
  const int status = real(clock, out);
  if (status == 0 && clock == CLOCK_REALTIME) out->tv_sec += jump();
  return status;
}

extern "C" int gettimeofday(timeval* out, void*) noexcept {
  timespec now = {};
  if (clock_gettime(CLOCK_REALTIME, &now) != 0) return -1;
  *out = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

extern "C" time_t time(time_t* out) noexcept {
  timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}

// The stream from a reader program, in pieces whose sizes the first byte gives.
#include <algorithm>

#include "input_file.h"
#include "raw_parts.h"
#include "stream_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace dismantle;
  if (size == 0) return 0;
  const std::size_t piece = std::size_t{data[0]} + 1;
  const auto bytes = std::as_bytes(fuzz::Bytes(data + 1, size - 1));
  reader_process::StreamReader reader(100'000, [](const std::string&, std::size_t, std::size_t) {});
  for (std::size_t at = 0; at < bytes.size(); at += piece)
    if (!reader.feed(bytes.subspan(at, std::min(piece, bytes.size() - at)))) {
      FUZZ_EXPECT(!reader.problem().empty() && !reader.complete());
      return 0;
    }
  if (reader.complete()) {
    const auto parts = reader.take_parts();
    if (!parts.empty()) fuzz::expect_sound(parts);
  }
  return 0;
}

#include "stream_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "stream_writer.h"

namespace dismantle::reader_process {
namespace {

/// The output of the writer.
template <class Fill>
std::string written(Fill fill) {
  std::FILE* out = std::tmpfile();
  StreamWriter writer(::fileno(out));
  fill(writer);
  std::string bytes(static_cast<std::size_t>(::lseek(::fileno(out), 0, SEEK_END)), '\0');
  std::rewind(out);
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), out));
  std::fclose(out);
  return bytes;
}

Body random_body(Rng& rng, std::size_t index) {
  Body body;
  body.name = "body " + std::to_string(index);
  for (auto n = rng.below(4); n-- > 0;) body.parents.push_back("parent" + std::to_string(n));
  if (rng.below(2))
    body.colour = {std::uint8_t(rng.below(256)), std::uint8_t(rng.below(256)), 3, std::uint8_t(rng.below(256))};
  if (rng.below(5) == 0) {
    body.problem = "it is a surface";
    body.by_meaning = rng.below(2) == 0;
    return body;
  }
  const std::size_t vertices = 4 + rng.below(rng.below(8) == 0 ? 60000 : 20);
  for (std::size_t i = 0; i < vertices; ++i)
    body.vertices.push_back({rng.uniform(-1e6, 1e6), rng.normal(), rng.uniform()});
  for (std::size_t i = 0; i < vertices; ++i)
    body.triangles.push_back({std::uint32_t(rng.below(vertices)), std::uint32_t(rng.below(vertices)), 0});
  return body;
}

std::string random_stream(Rng& rng, std::vector<Body>& bodies) {
  for (auto n = 1 + rng.below(4); n-- > 0;) bodies.push_back(random_body(rng, bodies.size()));
  return written([&](StreamWriter& writer) {
    writer.unit("inch");
    for (const Body& body : bodies) {
      writer.phase("tessellating", 1, 2);
      writer.body(body);
    }
    writer.warning("a curve is left aside");
    writer.note("names are in Latin-1");
    writer.end();
  });
}

/// Feeds `stream` in pieces of random length.
bool feed(StreamReader& reader, const std::string& stream, Rng& rng) {
  for (std::size_t i = 0; i < stream.size();) {
    const std::size_t n = std::min<std::size_t>(stream.size() - i, 1 + rng.below(rng.below(2) ? 7 : 70000));
    if (!reader.feed(std::as_bytes(std::span(stream.data() + i, n)))) return false;
    i += n;
  }
  return true;
}

TEST(StepStream, WhatIsWrittenIsReadBitForBitHoweverItIsCut) {
  Rng rng(1);
  for (int round = 0; round < 40; ++round) {
    std::vector<Body> bodies;
    const std::string stream = random_stream(rng, bodies);
    std::size_t phases = 0;
    StreamReader reader(1'000'000, [&](const std::string&, std::size_t, std::size_t) { ++phases; });
    ASSERT_TRUE(feed(reader, stream, rng)) << reader.problem();
    EXPECT_TRUE(reader.complete());
    EXPECT_EQ(phases, bodies.size());
    EXPECT_EQ(reader.warnings(), std::vector<std::string>{"a curve is left aside"});
    EXPECT_EQ(reader.notes(), std::vector<std::string>{"names are in Latin-1"});
    const auto parts = reader.take_parts();
    ASSERT_EQ(parts.size(), bodies.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
      EXPECT_EQ(parts[i].name, bodies[i].name);
      EXPECT_EQ(parts[i].parents, bodies[i].parents);
      EXPECT_EQ(parts[i].problem, bodies[i].problem);
      EXPECT_EQ(parts[i].by_meaning, bodies[i].by_meaning);
      EXPECT_EQ(parts[i].unit, "inch");
      ASSERT_EQ(parts[i].colour.has_value(), bodies[i].colour.has_value());
      if (parts[i].colour) {
        EXPECT_EQ(parts[i].colour->g, (*bodies[i].colour)[1]);
      }
      ASSERT_EQ(parts[i].mesh.vertices.size(), bodies[i].vertices.size());
      for (std::size_t v = 0; v < bodies[i].vertices.size(); ++v)
        for (int k = 0; k < 3; ++k)
          ASSERT_EQ(parts[i].mesh.vertices[v][k], bodies[i].vertices[v][static_cast<std::size_t>(k)]);
      EXPECT_EQ(parts[i].mesh.triangles, bodies[i].triangles);
    }
  }
}

TEST(StepStream, AStreamThatIsCutOffIsNeverComplete) {
  Rng rng(2);
  for (int round = 0; round < 300; ++round) {
    std::vector<Body> bodies;
    std::string stream = random_stream(rng, bodies);
    stream.resize(rng.below(stream.size()));
    StreamReader reader(1'000'000, {});
    feed(reader, stream, rng);
    EXPECT_FALSE(reader.complete());
  }
}

TEST(StepStream, DamageGivesValidPartsOrAProblem) {
  Rng rng(3);
  std::size_t problems = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<Body> bodies;
    std::string stream = random_stream(rng, bodies);
    if (stream.size() > 20000) continue;
    for (auto n = 1 + rng.below(4); n-- > 0;) stream[rng.below(stream.size())] = static_cast<char>(rng.below(256));
    StreamReader reader(1'000'000, {});
    feed(reader, stream, rng);
    problems += !reader.problem().empty();
    for (const RawPart& part : reader.take_parts()) {
      for (const auto& v : part.mesh.vertices) EXPECT_TRUE(v.allFinite());
      for (const auto& t : part.mesh.triangles)
        for (const auto corner : t) EXPECT_LT(corner, part.mesh.vertices.size());
    }
  }
  EXPECT_GT(problems, 300u);  // most damage hits coordinates, which may have any value
}

TEST(StepStream, PromisesTakeNoMemory) {
  // A body of 2^60 triangles, a record of 4 GB, a text of 4 GB: refused before the bytes come.
  const auto expect_refused = [](const std::string& bytes) {
    StreamReader reader(std::numeric_limits<std::uint64_t>::max() / 4, {});
    EXPECT_FALSE(reader.feed(std::as_bytes(std::span(bytes.data(), bytes.size()))));
    EXPECT_NE(reader.problem(), "");
  };
  const std::string magic(kMagic, sizeof kMagic);
  expect_refused(magic + "W" + std::string(4, '\xFF'));
  expect_refused(magic + "W" + std::string("\x08\0\0\0", 4) + std::string(4, '\xFF') + "text");
  expect_refused("something else that is no stream");
  Body body;
  body.name = "x";
  body.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  body.triangles = {{0, 1, 2}};
  const std::string whole = written([&](StreamWriter& writer) {
    writer.body(body);
    writer.end();
  });
  StreamReader few(0, {});
  EXPECT_FALSE(few.feed(std::as_bytes(std::span(whole.data(), whole.size()))));
  EXPECT_EQ(few.problem(), "too many triangles");
}

/// A record of vertices or triangles before any body, empty or not.
TEST(StepStream, GeometryOfNoBodyIsRefused) {
  const std::string magic(kMagic, sizeof kMagic);
  for (const char tag : {'V', 'T'})
    for (const std::uint32_t size : {0U, 12U, 24U}) {
      std::string bytes = magic + tag + std::string(reinterpret_cast<const char*>(&size), sizeof size);
      bytes += std::string(size, '\0');
      StreamReader reader(10, {});
      EXPECT_FALSE(reader.feed(std::as_bytes(std::span(bytes.data(), bytes.size())))) << tag << size;
      EXPECT_NE(reader.problem().find("of no body"), std::string::npos) << reader.problem();
    }
}

TEST(StepStream, CoordinatesAreFiniteAndCornersExist) {
  Body body;
  body.name = "x";
  body.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  body.triangles = {{0, 1, 3}};
  const auto problem = [](const Body& b) {
    const std::string bytes = written([&](StreamWriter& writer) { writer.body(b); });
    StreamReader reader(10, {});
    reader.feed(std::as_bytes(std::span(bytes.data(), bytes.size())));
    return reader.problem();
  };
  EXPECT_EQ(problem(body), "'x': a triangle names vertex 3 of 3");
  body.triangles = {{0, 1, 2}};
  EXPECT_EQ(problem(body), "");
  body.vertices[1][2] = std::nan("");
  EXPECT_EQ(problem(body), "'x': a coordinate is no finite number");
}

}  // namespace
}  // namespace dismantle::reader_process

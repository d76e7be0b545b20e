// assimp_reader FILE: reads a glTF, 3MF or DAE file and writes its parts to standard output in the format of
// stream_format.h. The importer starts it as a separate process because assimp may crash, hang or use all memory.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "dismantle/errors.h"
#include "scene.h"
#include "stream_writer.h"

namespace dismantle::mesh_files {
namespace {

using reader_process::Body;
using reader_process::Failure;
using reader_process::StreamWriter;

Body body_of(const RawPart& part) {
  Body body;
  body.name = part.name;
  body.parents = part.parents;
  body.problem = part.problem;
  body.by_meaning = part.by_meaning;
  if (part.colour) body.colour = {part.colour->r, part.colour->g, part.colour->b, part.colour->a};
  for (const auto& v : part.mesh.vertices) body.vertices.push_back({v.x(), v.y(), v.z()});
  body.triangles.assign(part.mesh.triangles.begin(), part.mesh.triangles.end());
  return body;
}

/// The error text without the file, which the importer adds.
std::string problem_of(const InputError& error) {
  const std::string text = error.what(), begin = error.subject() + ": ";
  return text.starts_with(begin) ? text.substr(begin.size()) : text;
}

int convert(const char* file, StreamWriter& out) {
  try {
    const PartsOfFile read = read_scene(file);
    for (const std::string& warning : read.warnings) out.warning(warning);
    for (const std::string& note : read.notes) out.note(note);
    if (!read.parts.empty()) out.unit(read.parts.front().unit);
    for (const RawPart& part : read.parts) out.body(body_of(part));
    out.end();
    return 0;
  } catch (const InputError& error) {
    out.failure(Failure::unreadable, problem_of(error));
  } catch (const std::bad_alloc&) {
    out.failure(Failure::out_of_memory, "");
  } catch (const std::exception& error) {
    out.failure(Failure::unreadable, error.what());
  }
  return 1;
}

}  // namespace
}  // namespace dismantle::mesh_files

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "assimp_reader is started by the importer of mesh files\n");
    return 2;
  }
  // assimp prints to standard output.
  const int stream = ::dup(STDOUT_FILENO);
  if (stream < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return 2;
  dismantle::reader_process::StreamWriter out(stream);
  const int status = dismantle::mesh_files::convert(argv[1], out);
  std::_Exit(status);  // destroying the scene takes time; the process ends anyway
}

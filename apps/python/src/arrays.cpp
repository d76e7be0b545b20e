#include "arrays.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace dismantle::python {
namespace {

std::string shape_of(const py::array& array) {
  std::string text;
  for (py::ssize_t d = 0; d < array.ndim(); ++d) text += fmt::format("{}{}", d > 0 ? ", " : "", array.shape(d));
  return "(" + text + (array.ndim() == 1 ? ",)" : ")");
}

[[noreturn]] void bad_shape(const std::string& what, const char* expected, const py::array& array) {
  throw py::value_error(fmt::format("{}: expected an array of shape {}, got {}", what, expected, shape_of(array)));
}

void write(const Pose& pose, double* out) {
  for (int k = 0; k < 3; ++k) out[k] = pose.t[k];
  out[3] = pose.q.w(), out[4] = pose.q.x(), out[5] = pose.q.y(), out[6] = pose.q.z();
}

Pose read(const double* in, const std::string& what) {
  Pose pose;
  pose.t = {in[0], in[1], in[2]};
  pose.q = Eigen::Quaterniond(in[3], in[4], in[5], in[6]);
  if (!pose.t.allFinite() || !pose.q.coeffs().allFinite())
    throw py::value_error(what + ": a pose holds numbers that are not finite");
  if (std::abs(pose.q.norm() - 1) > 1e-6)
    throw py::value_error(
        fmt::format("{}: the quaternion (columns 3 to 6: w, x, y, z) has length {:.6g}, not 1", what, pose.q.norm()));
  // Quaternions of unit length up to rounding are kept, so that poses from Python are returned bit by bit.
  const double rounding = 8 * std::numeric_limits<double>::epsilon();  // of the squared length after normalising
  if (std::abs(pose.q.squaredNorm() - 1) > rounding) pose.q.normalize();
  return pose;
}

}  // namespace

Array array_of(const Eigen::Vector3d& v) {
  Array out(3);
  for (int k = 0; k < 3; ++k) out.mutable_at(k) = v[k];
  return out;
}

Array array_of(const std::vector<Eigen::Vector3d>& points) {
  Array out({points.size(), std::size_t{3}});
  double* to = out.mutable_data();
  for (const auto& p : points)
    for (int k = 0; k < 3; ++k) *to++ = p[k];
  return out;
}

Array array_of(const Pose& pose) {
  Array out(7);
  write(pose, out.mutable_data());
  return out;
}

Array array_of(const std::vector<Pose>& poses) {
  Array out({poses.size(), std::size_t{7}});
  for (std::size_t i = 0; i < poses.size(); ++i) write(poses[i], out.mutable_data() + 7 * i);
  return out;
}

Array array_of_path(const Path& path, std::size_t bodies) {
  Array out({path.size(), bodies, std::size_t{7}});
  double* to = out.mutable_data();
  for (const auto& instant : path)
    for (std::size_t i = 0; i < bodies; ++i, to += 7) write(instant.at(i), to);
  return out;
}

Indices array_of(const std::vector<Triangle>& triangles) {
  Indices out({triangles.size(), std::size_t{3}});
  std::int64_t* to = out.mutable_data();
  for (const auto& t : triangles)
    for (const std::uint32_t index : t) *to++ = index;
  return out;
}

Eigen::Vector3d vector_of(const Array& array, const std::string& what) {
  if (array.ndim() != 1 || array.shape(0) != 3) bad_shape(what, "(3,)", array);
  return {array.at(0), array.at(1), array.at(2)};
}

std::vector<Eigen::Vector3d> points_of(const Array& array, const std::string& what) {
  if (array.ndim() != 2 || array.shape(1) != 3) bad_shape(what, "(N, 3)", array);
  std::vector<Eigen::Vector3d> points(static_cast<std::size_t>(array.shape(0)));
  const double* from = array.data();
  for (auto& p : points) p = {from[0], from[1], from[2]}, from += 3;
  return points;
}

Pose pose_of(const Array& array, const std::string& what) {
  if (array.ndim() != 1 || array.shape(0) != 7) bad_shape(what, "(7,)", array);
  return read(array.data(), what);
}

std::vector<Pose> poses_of(const Array& array, const std::string& what) {
  if (array.ndim() == 1 && array.shape(0) == 7) return {read(array.data(), what)};
  if (array.ndim() != 2 || array.shape(1) != 7) bad_shape(what, "(N, 7)", array);
  std::vector<Pose> poses;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) poses.push_back(read(array.data() + 7 * i, what));
  return poses;
}

Path path_of(const Array& array, std::size_t bodies, const std::string& what) {
  const bool flat = array.ndim() == 2 && array.shape(1) == 7 && bodies == 1;
  const bool full = array.ndim() == 3 && array.shape(2) == 7 && static_cast<std::size_t>(array.shape(1)) == bodies;
  if (!flat && !full)
    bad_shape(what, bodies == 1 ? "(K, 7) or (K, 1, 7)" : fmt::format("(K, {}, 7)", bodies).c_str(), array);
  Path path;
  for (py::ssize_t k = 0; k < array.shape(0); ++k) {
    auto& instant = path.emplace_back();
    for (std::size_t i = 0; i < bodies; ++i)
      instant.push_back(read(array.data() + 7 * (static_cast<std::size_t>(k) * bodies + i), what));
  }
  return path;
}

Mesh mesh_of(const Array& vertices, const Indices& triangles, const std::string& what) {
  Mesh mesh;
  mesh.vertices = points_of(vertices, what + ": vertices");
  if (triangles.ndim() != 2 || triangles.shape(1) != 3) bad_shape(what + ": triangles", "(F, 3)", triangles);
  for (py::ssize_t f = 0; f < triangles.shape(0); ++f) {
    Triangle triangle{};
    for (py::ssize_t k = 0; k < 3; ++k) {
      const std::int64_t index = triangles.at(f, k);
      if (index < 0 || static_cast<std::size_t>(index) >= mesh.vertices.size())
        throw py::value_error(fmt::format("{}: triangle {} names vertex {}; there are {} (counted from 0)", what, f,
                                          index, mesh.vertices.size()));
      triangle[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(index);
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace dismantle::python

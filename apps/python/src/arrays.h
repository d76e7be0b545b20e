/// Conversions from and to numpy arrays. A pose is a row of seven numbers: x, y, z, qw, qx, qy, qz, as in plan.json.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "dismantle/mesh.h"
#include "dismantle/path_planner.h"
#include "dismantle/pose.h"

namespace dismantle::python {

namespace py = pybind11;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

Array array_of(const Eigen::Vector3d& v);                    ///< (3,)
Array array_of(const std::vector<Eigen::Vector3d>& points);  ///< (N, 3)
Array array_of(const Pose& pose);                            ///< (7,)
Array array_of(const std::vector<Pose>& poses);              ///< (N, 7)
Array array_of_path(const Path& path, std::size_t bodies);   ///< (K, M, 7)
Indices array_of(const std::vector<Triangle>& triangles);    ///< (F, 3)

/// All throw ValueError that names `what` and the expected shape. The length of a quaternion may deviate from 1 by
/// 1e-6; quaternions are normalised.
Eigen::Vector3d vector_of(const Array& array, const std::string& what);
std::vector<Eigen::Vector3d> points_of(const Array& array, const std::string& what);
Pose pose_of(const Array& array, const std::string& what);
std::vector<Pose> poses_of(const Array& array, const std::string& what);  ///< (N, 7), or (7,) for one
/// (K, M, 7), or (K, 7) for one moving part.
Path path_of(const Array& array, std::size_t bodies, const std::string& what);
Mesh mesh_of(const Array& vertices, const Indices& triangles, const std::string& what);

}  // namespace dismantle::python

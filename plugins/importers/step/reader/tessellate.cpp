#include "tessellate.h"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <numeric>

namespace dismantle::step_import {
namespace {

/// Joins the vertices of faces, since Open CASCADE gives every face its own. By the topology these vertices are equal:
/// the nodes of an edge on both its faces, the ends of the edges at a vertex, all nodes of an edge without length.
class Welder {
 public:
  Surface weld(const TopoDS_Shape& shape) {
    for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next())
      if (const auto& face = TopoDS::Face(it.Current());
          face.Orientation() == TopAbs_FORWARD || face.Orientation() == TopAbs_REVERSED)
        add(face);
    return take();
  }

 private:
  void add(const TopoDS_Face& face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) triangulation = BRep_Tool::Triangulation(face, location);
    if (triangulation.IsNull() || triangulation->NbTriangles() == 0) {
      ++surface_.missing_faces;
      return;
    }
    const auto base = static_cast<std::uint32_t>(points_.size()) - 1;  // nodes count from 1
    for (int i = 1; i <= triangulation->NbNodes(); ++i) {
      const gp_Pnt p = triangulation->Node(i).Transformed(location.Transformation());
      points_.push_back({p.X(), p.Y(), p.Z()});
      same_.push_back(static_cast<std::uint32_t>(same_.size()));
    }
    for (TopExp_Explorer it(face, TopAbs_EDGE); it.More(); it.Next())
      join(TopoDS::Edge(it.Current()), triangulation, location, base);
    FaceRange range{face, 0};
    for (int i = 1; i <= triangulation->NbTriangles(); ++i) {
      int a = 0, b = 0, c = 0;
      triangulation->Triangle(i).Get(a, b, c);
      if (face.Orientation() == TopAbs_REVERSED) std::swap(b, c);
      triangles_.push_back({base + static_cast<std::uint32_t>(a), base + static_cast<std::uint32_t>(b),
                            base + static_cast<std::uint32_t>(c)});
      range.area += area(triangles_.back());
    }
    surface_.faces.push_back(range);
  }

  void join(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & triangulation, const TopLoc_Location& location,
            std::uint32_t base) {
    const Handle(Poly_PolygonOnTriangulation) polygon =
        BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
    if (polygon.IsNull() || polygon->NbNodes() == 0) return;
    std::vector<std::uint32_t> nodes;
    for (int i = 1; i <= polygon->NbNodes(); ++i) {
      const int node = polygon->Node(i);
      if (node < 1 || node > triangulation->NbNodes()) return;
      nodes.push_back(base + static_cast<std::uint32_t>(node));
    }
    if (BRep_Tool::Degenerated(edge))
      for (const auto node : nodes) unite(nodes.front(), node);
    TopoDS_Vertex first, last;
    TopExp::Vertices(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), first, last);
    meet(first, nodes.front());
    meet(last, nodes.back());
    if (int known = 0; edges_.Find(edge, known)) {
      const auto& others = polygons_[static_cast<std::size_t>(known)];
      if (others.size() != nodes.size()) {
        ++surface_.mismatched_edges;
        return;
      }
      for (std::size_t i = 0; i < nodes.size(); ++i) unite(others[i], nodes[i]);
    } else {
      edges_.Bind(edge, static_cast<int>(polygons_.size()));
      polygons_.push_back(std::move(nodes));
    }
  }

  void meet(const TopoDS_Vertex& vertex, std::uint32_t node) {
    if (vertex.IsNull()) return;
    if (int known = 0; vertices_.Find(vertex, known))
      unite(static_cast<std::uint32_t>(known), node);
    else
      vertices_.Bind(vertex, static_cast<int>(node));
  }

  std::uint32_t find(std::uint32_t i) {
    while (same_[i] != i) i = same_[i] = same_[same_[i]];
    return i;
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    a = find(a);
    b = find(b);
    same_[std::max(a, b)] = std::min(a, b);
  }

  double area(const std::array<std::uint32_t, 3>& t) const {
    const gp_XYZ a(points_[t[0]][0], points_[t[0]][1], points_[t[0]][2]),
        b(points_[t[1]][0], points_[t[1]][1], points_[t[1]][2]),
        c(points_[t[2]][0], points_[t[2]][1], points_[t[2]][2]);
    return (b - a).Crossed(c - a).Modulus() / 2;
  }

  Surface take() {
    const auto unused = static_cast<std::uint32_t>(-1);
    std::vector<std::uint32_t> index(points_.size(), unused);
    double volume = 0;
    for (auto t : triangles_) {
      for (auto& i : t) i = find(i);
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      const auto& a = points_[t[0]];
      const auto& b = points_[t[1]];
      const auto& c = points_[t[2]];
      volume += gp_XYZ(a[0], a[1], a[2]).Dot(gp_XYZ(b[0], b[1], b[2]).Crossed(gp_XYZ(c[0], c[1], c[2])));
      for (auto& i : t) {
        if (index[i] == unused) {
          index[i] = static_cast<std::uint32_t>(surface_.vertices.size());
          surface_.vertices.push_back(points_[i]);
        }
        i = index[i];
      }
      surface_.triangles.push_back(t);
    }
    if (volume < 0)
      for (auto& t : surface_.triangles) std::swap(t[1], t[2]);
    return std::move(surface_);
  }

  Surface surface_;
  std::vector<std::array<double, 3>> points_;
  std::vector<std::uint32_t> same_;  // union-find: the smallest index represents all
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  TopTools_DataMapOfShapeInteger edges_, vertices_;
  std::vector<std::vector<std::uint32_t>> polygons_;
};

}  // namespace

Surface tessellate(const TopoDS_Shape& shape, double linear, double angular) {
  const TopoDS_Shape local = shape.Located(TopLoc_Location());
  // One thread, so that the result does not depend on the number of threads.
  BRepMesh_IncrementalMesh mesher(local, linear, Standard_False, angular, Standard_False);
  Surface surface = Welder().weld(local);
  BRepTools::Clean(local);  // frees the triangulation that Open CASCADE keeps
  return surface;
}

}  // namespace dismantle::step_import

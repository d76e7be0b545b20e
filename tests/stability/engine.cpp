#include "engine.h"

#include <btBulletDynamicsCommon.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

namespace dismantle::statics::testing {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kStep = 0.002, kGravity = 10;
constexpr int kIterations = 100;
constexpr btScalar kMargin = 1e-4F;  // outside of each hull

btVector3 bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// About the centre of the bounding box.
std::unique_ptr<btConvexShape> shape_of(const Mesh& mesh, const Aabb& box) {
  const Vec3 half = 0.5 * (box.hi - box.lo), center = box.center();
  const bool is_box = std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [&](const Vec3& v) {
    return ((v - center).cwiseAbs() - half).cwiseAbs().maxCoeff() < 1e-9 * half.norm();
  });
  if (is_box) return std::make_unique<btBoxShape>(bullet(half));
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Vec3& v : mesh.vertices) hull->addPoint(bullet(v - center), false);
  hull->recalcLocalAabb();
  hull->setMargin(kMargin);
  hull->initializePolyhedralFeatures();
  return hull;
}

/// Volume, centre of mass and moments of inertia by tetrahedra.
struct MassProperties {
  double volume = 0;
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the centre
};

MassProperties mass_of(const Mesh& mesh) {
  MassProperties m;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double volume = a.dot(b.cross(c)) / 6;
    const Vec3 sum = a + b + c;
    m.volume += volume;
    m.center += volume * sum / 4;
    second += volume / 20 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  m.center /= m.volume;
  second -= m.volume * m.center * m.center.transpose();
  m.inertia = second.trace() * Eigen::Matrix3d::Identity() - second;
  return m;
}

}  // namespace

double moved_in_engine(const Scene& scene, double seconds) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.getSolverInfo().m_numIterations = kIterations;
  world.getSolverInfo().m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  world.getDispatchInfo().m_enableSatConvex = true;
  world.setGravity(bullet(kGravity * scene.down));

  struct Solid {
    std::unique_ptr<btConvexShape> hull;
    std::unique_ptr<btCompoundShape> shape;
    std::unique_ptr<btRigidBody> body;
    btTransform start;
    std::vector<btVector3> corners;
  };
  std::vector<Solid> solids;
  for (const Mesh& mesh : scene.solids) {
    const MassProperties mass = mass_of(mesh);
    // A body turns about its centre of mass; its axes are those of the world, the inertia is that about them.
    Solid& s = solids.emplace_back();
    const Aabb box = mesh.box();
    s.hull = shape_of(mesh, box);
    btTransform offset = btTransform::getIdentity();
    offset.setOrigin(bullet(box.center() - mass.center));
    s.shape = std::make_unique<btCompoundShape>();
    s.shape->addChildShape(offset, s.hull.get());
    s.start = btTransform::getIdentity();
    s.start.setOrigin(bullet(mass.center));
    const bool fixed = solids.size() <= scene.fixed;
    const Vec3 inertia = fixed ? Vec3(Vec3::Zero()) : Vec3(mass.inertia.diagonal());
    btRigidBody::btRigidBodyConstructionInfo info(fixed ? 0 : static_cast<btScalar>(mass.volume), nullptr,
                                                  s.shape.get(), bullet(inertia));
    info.m_startWorldTransform = s.start;
    info.m_friction = static_cast<btScalar>(std::sqrt(scene.friction));  // the engine multiplies those of a pair
    s.body = std::make_unique<btRigidBody>(info);
    s.body->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(s.body.get());
    for (const Vec3& v : mesh.vertices) s.corners.push_back(bullet(v - mass.center));
  }
  for (int k = 0; k < static_cast<int>(seconds / kStep); ++k) world.stepSimulation(static_cast<btScalar>(kStep), 0);
  double most = 0;
  for (const Solid& s : solids)
    for (const btVector3& corner : s.corners)
      most = std::max(most, static_cast<double>((s.body->getWorldTransform() * corner - s.start * corner).length()));
  for (const Solid& s : solids) world.removeRigidBody(s.body.get());
  return most;
}

}  // namespace dismantle::statics::testing

// SPDX-License-Identifier: MIT
#include <ode/ode.h>

#include <array>
#include <numbers>

#include "peers.h"

namespace gatewalk::bench {
namespace {

class Ode final : public Engine {
 public:
  explicit Ode(const dynamics::GateParams& p) : p_(p) {
    static const int started = dInitODE2(0);
    static_cast<void>(started);
    world_ = dWorldCreate();
    contacts_ = dJointGroupCreate(0);
    const double half = 0.5 * p.beams.length, rod = p.beams.mass * half * half / 3.0;
    for (const auto side : {dynamics::kLeft, dynamics::kRight}) {
      const double sign = side == dynamics::kLeft ? 1.0 : -1.0;
      dBodyID beam = beams_[side] = dBodyCreate(world_);
      dMass mass;
      dMassSetParameters(&mass, p.beams.mass, 0, 0, 0, 1e-3 * rod, rod, rod, 0, 0, 0);
      dBodySetMass(beam, &mass);
      dBodySetPosition(beam, -sign * p.beams.joint_x + sign * half, p.beams.joint_y, 0.0);
      hinges_[side] = dJointCreateHinge(world_, nullptr);
      dJointAttach(hinges_[side], beam, nullptr);
      dJointSetHingeAnchor(hinges_[side], -sign * p.beams.joint_x, p.beams.joint_y, 0.0);
      dJointSetHingeAxis(hinges_[side], 0.0, 0.0, 1.0);
      rods_[side] = dCreateCapsule(nullptr, kThin, p.beams.length);
      dGeomSetBody(rods_[side], beam);
      dMatrix3 turned;  // capsules lie along z
      dRFromAxisAndAngle(turned, 0.0, 1.0, 0.0, 0.5 * std::numbers::pi);
      dGeomSetOffsetRotation(rods_[side], turned);
    }
    disc_ = dBodyCreate(world_);
    dMass mass;
    dMassSetSphereTotal(&mass, p.body.mass, p.body.radius);
    dBodySetMass(disc_, &mass);
    sphere_ = dCreateSphere(nullptr, p.body.radius - kThin);
    dGeomSetBody(sphere_, disc_);
    dJointAttach(dJointCreatePlane2D(world_, nullptr), disc_, nullptr);
  }
  ~Ode() override {
    for (dGeomID geom : {rods_[0], rods_[1], sphere_}) dGeomDestroy(geom);
    dJointGroupDestroy(contacts_);
    dWorldDestroy(world_);
  }
  Ode(const Ode&) = delete;
  Ode& operator=(const Ode&) = delete;

  dynamics::BodyState step(double force_x) override {
    for (const auto side : {dynamics::kLeft, dynamics::kRight}) {
      touch(side);
      dJointAddHingeTorque(hinges_[side],
                           -p_.beams.stiffness(side) * dJointGetHingeAngle(hinges_[side]) -
                               p_.beams.damping * dJointGetHingeAngleRate(hinges_[side]));
    }
    dBodyAddForce(disc_, force_x, p_.forces.propulsion, 0.0);
    dWorldStep(world_, p_.run.step);
    dJointGroupEmpty(contacts_);
    const dReal* at = dBodyGetPosition(disc_);
    return {.x = at[0], .y = at[1]};
  }

 private:
  static constexpr double kThin = 1e-3;  // m, a capsule's radius; the disc is smaller by it

  void touch(dynamics::Side side) {
    dContact contact{};
    if (dCollide(sphere_, rods_[side], 1, &contact.geom, sizeof(dContactGeom)) == 0) return;
    const double sign = side == dynamics::kLeft ? 1.0 : -1.0;
    const dReal* at = dBodyGetPosition(disc_);
    const dReal* r = dBodyGetRotation(beams_[side]);
    contact.surface.mode = dContactBounce;
    contact.surface.bounce = restitution(p_, at[0] + sign * p_.beams.joint_x,
                                         at[1] - p_.beams.joint_y, sign * r[0], sign * r[4]);
    dJointAttach(dJointCreateContact(world_, contacts_, &contact), disc_, beams_[side]);
  }

  const dynamics::GateParams& p_;
  dWorldID world_ = nullptr;
  dJointGroupID contacts_ = nullptr;
  std::array<dBodyID, 2> beams_{};
  std::array<dJointID, 2> hinges_{};
  std::array<dGeomID, 2> rods_{};
  dBodyID disc_ = nullptr;
  dGeomID sphere_ = nullptr;
};

}  // namespace

std::unique_ptr<Engine> make_ode(const dynamics::GateParams& p) { return std::make_unique<Ode>(p); }

}  // namespace gatewalk::bench

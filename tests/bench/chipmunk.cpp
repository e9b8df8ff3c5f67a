// SPDX-License-Identifier: MIT
#include <chipmunk/chipmunk.h>

#include <array>
#include <type_traits>
#include <vector>

#include "peers.h"

namespace gatewalk::bench {
namespace {

class Chipmunk final : public Engine {
 public:
  explicit Chipmunk(const dynamics::GateParams& p) : p_(p), space_(cpSpaceNew()) {
    constexpr cpCollisionType kBeam = 1, kDisc = 2;
    const double length = p.beams.length, rod = p.beams.mass * length * length / 12.0;
    for (const auto side : {dynamics::kLeft, dynamics::kRight}) {
      const double sign = side == dynamics::kLeft ? 1.0 : -1.0;
      const cpVect joint = cpv(-sign * p.beams.joint_x, p.beams.joint_y);
      beams_[side] = cpSpaceAddBody(space_, cpBodyNew(p.beams.mass, rod));
      cpBodySetPosition(beams_[side], cpvadd(joint, cpv(sign * 0.5 * length, 0.0)));
      // Ends in the body's frame: the joint first.
      cpShape* shape = cpSegmentShapeNew(beams_[side], cpv(-sign * 0.5 * length, 0.0),
                                         cpv(sign * 0.5 * length, 0.0), 0.0);
      cpShapeSetFilter(shape, cpShapeFilterNew(1, CP_ALL_CATEGORIES, CP_ALL_CATEGORIES));
      cpShapeSetCollisionType(shape, kBeam);
      cpSpaceAddShape(space_, shape);
      cpBody* ground = cpSpaceGetStaticBody(space_);
      cpSpaceAddConstraint(space_, cpPivotJointNew(ground, beams_[side], joint));
      cpSpaceAddConstraint(
          space_, cpDampedRotarySpringNew(ground, beams_[side], 0.0, p.beams.stiffness(side),
                                          p.beams.damping));
    }
    disc_ = cpSpaceAddBody(
        space_,
        cpBodyNew(p.body.mass, cpMomentForCircle(p.body.mass, 0.0, p.body.radius, cpvzero)));
    cpShape* shape = cpSpaceAddShape(space_, cpCircleShapeNew(disc_, p.body.radius, cpvzero));
    cpShapeSetCollisionType(shape, kDisc);
    cpCollisionHandler* handler = cpSpaceAddCollisionHandler(space_, kBeam, kDisc);
    handler->userData = this;
    handler->preSolveFunc = [](cpArbiter* hit, cpSpace*, cpDataPointer self) -> cpBool {
      static_cast<Chipmunk*>(self)->choose_restitution(hit);
      return cpTrue;
    };
  }
  ~Chipmunk() override {
    const auto collect = [](auto* object, void* list) {
      static_cast<std::vector<std::remove_pointer_t<decltype(object)>*>*>(list)->push_back(object);
    };
    std::vector<cpShape*> shapes;
    std::vector<cpConstraint*> constraints;
    cpSpaceEachShape(space_, collect, &shapes);
    cpSpaceEachConstraint(space_, collect, &constraints);
    cpSpaceFree(space_);
    for (cpShape* shape : shapes) cpShapeFree(shape);
    for (cpConstraint* constraint : constraints) cpConstraintFree(constraint);
    for (cpBody* body : {beams_[0], beams_[1], disc_}) cpBodyFree(body);
  }
  Chipmunk(const Chipmunk&) = delete;
  Chipmunk& operator=(const Chipmunk&) = delete;

  dynamics::BodyState step(double force_x) override {
    cpBodySetForce(disc_, cpv(force_x, p_.forces.propulsion));
    cpSpaceStep(space_, p_.run.step);
    const cpVect at = cpBodyGetPosition(disc_);
    return {.x = at.x, .y = at.y};
  }

 private:
  void choose_restitution(cpArbiter* hit) const {
    cpBody *beam, *disc;
    cpArbiterGetBodies(hit, &beam, &disc);
    const double sign = beam == beams_[dynamics::kLeft] ? 1.0 : -1.0;
    const cpVect along = cpvmult(cpBodyGetRotation(beam), sign);
    const cpVect joint = cpvsub(cpBodyGetPosition(beam), cpvmult(along, 0.5 * p_.beams.length));
    const cpVect d = cpvsub(cpBodyGetPosition(disc), joint);
    cpArbiterSetRestitution(hit, restitution(p_, d.x, d.y, along.x, along.y));
  }

  const dynamics::GateParams& p_;
  cpSpace* space_;
  std::array<cpBody*, 2> beams_{};
  cpBody* disc_ = nullptr;
};

}  // namespace

std::unique_ptr<Engine> make_chipmunk(const dynamics::GateParams& p) {
  return std::make_unique<Chipmunk>(p);
}

}  // namespace gatewalk::bench

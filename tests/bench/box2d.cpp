// SPDX-License-Identifier: MIT
#include <box2d/box2d.h>

#include <array>

#include "peers.h"

namespace gatewalk::bench {
namespace {

/// Box2D expects moving bodies of 0.1 to 10 m, so its unit of length is 10 m here. Times and masses
/// are unchanged, so forces are in 10 N and torques in 100 N m.
constexpr double kUnit = 10.0;
constexpr float length(double metres) { return static_cast<float>(metres / kUnit); }

class Box2D final : public Engine, b2ContactListener {
 public:
  explicit Box2D(const dynamics::GateParams& p) : p_(p), world_(b2Vec2(0.0F, 0.0F)) {
    world_.SetContactListener(this);
    b2BodyDef fixed;
    b2Body* ground = world_.CreateBody(&fixed);
    for (const auto side : {dynamics::kLeft, dynamics::kRight}) {
      const float sign = side == dynamics::kLeft ? 1.0F : -1.0F;
      b2BodyDef def;
      def.type = b2_dynamicBody;
      def.position.Set(length(-sign * p.beams.joint_x), length(p.beams.joint_y));
      def.allowSleep = false;
      beams_[side] = world_.CreateBody(&def);
      const b2Vec2 tip(sign * length(p.beams.length), 0.0F);
      b2EdgeShape edge;
      edge.SetTwoSided(b2Vec2(0.0F, 0.0F), tip);
      b2FixtureDef fixture;
      fixture.shape = &edge;
      fixture.friction = 0.0F;
      fixture.restitutionThreshold = 0.0F;
      fixture.filter.groupIndex = -1;
      beams_[side]->CreateFixture(&fixture);
      // An edge has no mass: the beam is a uniform rod about its joint.
      const b2MassData rod{static_cast<float>(p.beams.mass), 0.5F * tip,
                           static_cast<float>(p.beams.inertia() / (kUnit * kUnit))};
      beams_[side]->SetMassData(&rod);
      b2RevoluteJointDef hinge;
      hinge.Initialize(ground, beams_[side], def.position);
      hinges_[side] = static_cast<b2RevoluteJoint*>(world_.CreateJoint(&hinge));
    }
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.allowSleep = false;
    disc_ = world_.CreateBody(&def);
    b2CircleShape circle;
    circle.m_radius = length(p.body.radius) - b2_polygonRadius;  // the edge's skin adds it
    b2FixtureDef fixture;
    fixture.shape = &circle;
    fixture.friction = 0.0F;
    fixture.restitutionThreshold = 0.0F;
    disc_->CreateFixture(&fixture);
    const b2MassData mass{static_cast<float>(p.body.mass), b2Vec2(0.0F, 0.0F), 1.0F};
    disc_->SetMassData(&mass);
  }

  dynamics::BodyState step(double force_x) override {
    disc_->ApplyForceToCenter({length(force_x), length(p_.forces.propulsion)}, true);
    for (const auto side : {dynamics::kLeft, dynamics::kRight}) {
      const double torque = -p_.beams.stiffness(side) * hinges_[side]->GetJointAngle() -
                            p_.beams.damping * hinges_[side]->GetJointSpeed();
      beams_[side]->ApplyTorque(static_cast<float>(torque / (kUnit * kUnit)), true);
    }
    world_.Step(static_cast<float>(p_.run.step), 8, 3);  // iterations as in the manual
    const b2Vec2 at = disc_->GetPosition();
    return {.x = at.x * kUnit, .y = at.y * kUnit};
  }

 private:
  void PreSolve(b2Contact* contact, const b2Manifold*) override {
    const b2Body* beam = contact->GetFixtureA()->GetBody();
    if (beam == disc_) beam = contact->GetFixtureB()->GetBody();
    const float sign = beam == beams_[dynamics::kLeft] ? 1.0F : -1.0F;
    const b2Vec2 along = sign * beam->GetTransform().q.GetXAxis();
    const b2Vec2 d = disc_->GetPosition() - beam->GetPosition();
    contact->SetRestitution(
        static_cast<float>(restitution(p_, d.x * kUnit, d.y * kUnit, along.x, along.y)));
  }

  const dynamics::GateParams& p_;
  b2World world_;
  std::array<b2Body*, 2> beams_{};
  std::array<b2RevoluteJoint*, 2> hinges_{};
  b2Body* disc_ = nullptr;
};

}  // namespace

std::unique_ptr<Engine> make_box2d(const dynamics::GateParams& p) {
  return std::make_unique<Box2D>(p);
}

}  // namespace gatewalk::bench

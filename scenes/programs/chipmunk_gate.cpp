// SPDX-License-Identifier: MIT
// The gate of scenes/field.toml as a cell program whose contacts are Chipmunk's: a disc pushes
// through two hinged, springy beams. Needs no part of gatewalk: c++ -O2 chipmunk_gate.cpp
// -lchipmunk. An entry is an entry of gatewalk's own gate; a body carries its exact place and the
// force that is held.

#include <chipmunk/chipmunk.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr double kMass = 1.0, kRadius = 10.0;                  // kg, m; of the disc
constexpr double kLength = 25.0, kBeamMass = 0.1;              // m, kg
constexpr double kJointX = 25.0, kJointY = 30.0, kTop = 60.0;  // m
constexpr double kDrag = 0.06, kTipRestitution = 1.0;          // N s/m, -
constexpr int kSteps = 3000, kStepsPerHold = 5, kDraws = kSteps / kStepsPerHold;  // 12 s, at 50 Hz
constexpr double kStep = 0.004;                                                   // s

struct Parameter {
  const char* key;
  double value;
};
enum { kPropulsion, kRandom, kStiffness, kDamping, kRestitution };
Parameter parameters[] = {{"propulsion_N", 7.0},
                          {"random_N", 50.0},
                          {"stiffness_Nm_per_rad", 400.0},
                          {"damping_Nms_per_rad", 50.0},
                          {"restitution", 0.8}};

std::FILE* out;  // where answers go

constexpr const char* kFaces[] = {"EN", "RD", "LD", "RT", "LT"};

/// What is carried from gate to gate: where the disc exactly is, and the draw in force.
struct Carried {
  double x, y, normal;
  int steps_left;
};

/// A gate with beams at rest, and the disc in it.
class Gate {
 public:
  Gate(cpVect at, cpVect velocity) : space_(cpSpaceNew()) {
    constexpr cpCollisionType kBeam = 1, kDisc = 2;
    for (int side = 0; side < 2; ++side) {
      const double sign = side == 0 ? 1.0 : -1.0;  // the left joint's beam points to the right
      const cpVect joint = cpv(-sign * kJointX, kJointY), half = cpv(sign * 0.5 * kLength, 0.0);
      beams_[side] =
          cpSpaceAddBody(space_, cpBodyNew(kBeamMass, kBeamMass * kLength * kLength / 12.0));
      cpBodySetPosition(beams_[side], cpvadd(joint, half));
      shapes_[side] = cpSegmentShapeNew(beams_[side], cpvneg(half), half, 0.0);
      cpShapeSetFilter(shapes_[side], cpShapeFilterNew(1, CP_ALL_CATEGORIES, CP_ALL_CATEGORIES));
      cpShapeSetCollisionType(shapes_[side], kBeam);
      cpBody* const ground = cpSpaceGetStaticBody(space_);
      hinges_[2 * side] = cpPivotJointNew(ground, beams_[side], joint);
      hinges_[2 * side + 1] = cpDampedRotarySpringNew(
          ground, beams_[side], 0.0, parameters[kStiffness].value, parameters[kDamping].value);
    }
    disc_ =
        cpSpaceAddBody(space_, cpBodyNew(kMass, cpMomentForCircle(kMass, 0.0, kRadius, cpvzero)));
    cpBodySetPosition(disc_, at);
    cpBodySetVelocity(disc_, velocity);
    shapes_[2] = cpCircleShapeNew(disc_, kRadius, cpvzero);
    cpShapeSetCollisionType(shapes_[2], kDisc);
    for (cpShape* shape : shapes_) cpSpaceAddShape(space_, shape);
    for (cpConstraint* hinge : hinges_) cpSpaceAddConstraint(space_, hinge);
    cpCollisionHandler* const handler = cpSpaceAddCollisionHandler(space_, kBeam, kDisc);
    handler->userData = this;
    handler->preSolveFunc = [](cpArbiter* hit, cpSpace*, cpDataPointer self) -> cpBool {
      static_cast<Gate*>(self)->choose_restitution(hit);
      return cpTrue;
    };
  }
  ~Gate() {
    cpSpaceFree(space_);
    for (cpShape* shape : shapes_) cpShapeFree(shape);
    for (cpConstraint* hinge : hinges_) cpConstraintFree(hinge);
    for (cpBody* body : {beams_[0], beams_[1], disc_}) cpBodyFree(body);
  }
  Gate(const Gate&) = delete;
  Gate& operator=(const Gate&) = delete;

  void step(double random_force) {
    const cpVect v = cpBodyGetVelocity(disc_);
    cpBodySetForce(disc_,
                   cpv(random_force - kDrag * v.x, parameters[kPropulsion].value - kDrag * v.y));
    cpSpaceStep(space_, kStep);
  }
  cpVect place() const { return cpBodyGetPosition(disc_); }
  cpVect velocity() const { return cpBodyGetVelocity(disc_); }

 private:
  /// Another one where the disc touches the free end of a beam.
  void choose_restitution(cpArbiter* hit) const {
    cpBody *beam, *disc;
    cpArbiterGetBodies(hit, &beam, &disc);
    const double sign = beam == beams_[0] ? 1.0 : -1.0;
    const cpVect along = cpvmult(cpBodyGetRotation(beam), sign);
    const cpVect from_middle = cpvsub(cpBodyGetPosition(disc), cpBodyGetPosition(beam));
    const bool at_tip = cpvdot(from_middle, along) >= 0.5 * kLength;
    cpArbiterSetRestitution(hit, at_tip ? kTipRestitution : parameters[kRestitution].value);
  }

  cpSpace* space_;
  std::array<cpBody*, 2> beams_{};
  std::array<cpShape*, 3> shapes_{};
  std::array<cpConstraint*, 4> hinges_{};
  cpBody* disc_;
};

/// The next word of a line; the line is cut up.
char* word(char*& line) {
  char* const begin = line + std::strspn(line, " \n");
  line = begin + std::strcspn(begin, " \n");
  if (*line != '\0') *line++ = '\0';
  return begin;
}
double number(char*& line) { return std::strtod(word(line), nullptr); }

/// ID FACE d vx vy SEED NORMALS... MEMORY
void answer(char* line) {
  const char* const id = word(line);
  const char* const face = word(line);
  const double d = number(line);
  const double vx = number(line), vy = number(line);
  word(line);  // the seed: all noise comes with the line
  char* draws = line;
  const char* const memory = std::strrchr(line, ' ') + 1;
  Carried body{face[0] == 'E'   ? d
               : face[0] == 'R' ? kJointX
                                : -kJointX,
               face[0] == 'E'   ? 0.0
               : face[1] == 'D' ? kJointY - d
                                : kJointY + d,
               0.0, 0};
  if (memory[0] != '-' || memory[1] != '\n')
    std::sscanf(memory, "%lf,%lf,%lf,%d", &body.x, &body.y, &body.normal, &body.steps_left);

  Gate gate(cpv(body.x, body.y), cpv(vx, vy));
  int steps = 0;
  cpVect at = gate.place();
  const auto is_inside = [&] { return std::abs(at.x) <= kJointX && at.y <= kTop; };
  for (; steps < kSteps && is_inside(); ++steps) {
    if (body.steps_left == 0) {
      body.normal = number(draws);
      body.steps_left = kStepsPerHold;
    }
    --body.steps_left;
    gate.step(parameters[kRandom].value * body.normal);
    at = gate.place();
  }
  const cpVect v = gate.velocity();
  if (!std::isfinite(at.x + at.y + v.x + v.y)) {
    std::fprintf(out, "%s broken\n", id);
  } else if (is_inside()) {
    std::fprintf(out, "%s trapped %.17g\n", id, steps * kStep);
  } else {
    const double side = at.y > kTop ? 0.0 : at.x > 0.0 ? 1.0 : -1.0;
    const int next = side == 0.0 ? 0 : (at.y < kJointY ? 1 : 3) + (side > 0.0);
    std::fprintf(out, "%s left %s %.17g %.17g %.17g %.17g %.17g,%.17g,%.17g,%d\n", id, kFaces[next],
                 next == 0 ? at.x : std::abs(at.y - kJointY), v.x, v.y, steps * kStep,
                 at.x - side * 2.0 * kJointX, at.y - (side == 0.0 ? kTop : 0.0), body.normal,
                 body.steps_left);
  }
}

}  // namespace

int main() {
  // Debian's build says on standard output that it was built with assertions.
  out = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  std::fprintf(
      out,
      R"({"gatewalk": 1, "symmetric": true, "normals": %d, "costs": [{"key": "time_s", "unit": "s"}], )"
      R"("coordinates": [{"name": "d", "unit": "m", "scale": 1}, {"name": "vx", "unit": "m s-1", "scale": 1}, )"
      R"({"name": "vy", "unit": "m s-1", "scale": 1}], )"
      R"("faces": [{"name": "EN", "move": [0, 1], "odd": ["d", "vx"]}, )"
      R"({"name": "RD", "move": [-1, 0], "mirror": "LD", "odd": ["vx"]}, )"
      R"({"name": "LD", "move": [1, 0], "mirror": "RD", "odd": ["vx"]}, )"
      R"({"name": "RT", "move": [-1, 0], "mirror": "LT", "odd": ["vx"]}, )"
      R"({"name": "LT", "move": [1, 0], "mirror": "RT", "odd": ["vx"]}], "parameters": {)",
      kDraws);
  for (const Parameter& p : parameters)
    std::fprintf(out, "%s\"%s\": [%.17g, 0, %s]", &p == parameters ? "" : ", ", p.key, p.value,
                 &p == &parameters[kRestitution] ? "1" : "1e6");
  std::fprintf(out, "}}\n");
  std::fflush(out);
  static char line[1 << 16];
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    char* rest = line;
    if (line[0] == '\n') {
      std::fflush(out);
    } else if (std::strncmp(line, "set ", 4) == 0) {
      word(rest);
      const char* const key = word(rest);
      const double value = number(rest);
      for (Parameter& p : parameters)
        if (std::strcmp(p.key, key) == 0) p.value = value;
    } else {
      answer(line);
    }
  }
}

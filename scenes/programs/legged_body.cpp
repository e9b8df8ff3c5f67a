// SPDX-License-Identifier: MIT
// A legged body of 0.25 kg that pushes through soft brushes, as a cell program. An entry has 3
// coordinates (place and velocity), 5 (heading and turning rate too) or 8 (phase of the gait,
// stride and leg load too), as the first argument says. No model of an animal: it shows how well
// error bars hold where a chain has many coordinates (results/coverage). Needs no part of gatewalk:
// c++ -O2 legged_body.cpp -o legged_body

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kHalfWidth = 0.1, kLength = 0.24;                // m; of the cell
constexpr double kMass = 0.25, kInertia = 4e-4;                   // kg, kg m2
constexpr double kDrag = 0.5, kTurnDrag = 2e-3, kUpright = 8e-3;  // N s/m, N m s, N m; per rad
constexpr double kBrush = 0.12, kBrushWidth = 0.025;  // m; middle and width of the brush
constexpr double kStep = 0.005, kMostTime = 3.0;      // s
constexpr double kStrides = 2.0, kSettle = 2.0;       // 1/s; per second, towards the mean

struct Parameter {
  const char* key;
  double value;
};
enum { kThrust, kNoise, kLeft, kRight };
Parameter parameters[] = {
    {"thrust_N", 0.3}, {"noise_N", 1.0}, {"brush_left_N", 0.9}, {"brush_right_N", 1.3}};

struct Noise {
  std::uint64_t state;
  double uniform() {  // splitmix64
    std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return (static_cast<double>((z ^ (z >> 31)) >> 11) + 0.5) * 0x1p-53;
  }
  double normal() {
    const double u = uniform(), v = uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
  }
};

/// The body: `at` holds the coordinates of an entry, with x in place of d.
enum { kX, kVx, kVy, kHeading, kTurn, kPhase, kStride, kLoad, kMost };
struct Body {
  double at[kMost] = {0, 0, 0, 0, 0, 0.5, 1.0, 1.0};
  double y = 0.0;
};

void step(Body& b, int coordinates, Noise& noise) {
  double* a = b.at;
  const double root = 0.1 / std::sqrt(kStep);  // white noise, per root of 0.01 s
  const double push = parameters[kNoise].value * root;
  double thrust = parameters[kThrust].value;
  if (coordinates == kMost) {
    a[kPhase] += kStep * kStrides * a[kStride];
    a[kPhase] -= std::floor(a[kPhase]);
    a[kStride] += kStep * kSettle * (1.0 - a[kStride]) + kStep * 0.3 * root * noise.normal();
    a[kLoad] += kStep * kSettle * (1.0 - a[kLoad]) + kStep * 0.3 * root * noise.normal();
    thrust *= a[kLoad] * (1.0 + 0.5 * std::sin(2.0 * kPi * a[kPhase]));
  }
  double fx = push * noise.normal() - kDrag * a[kVx], fy = thrust - kDrag * a[kVy];
  const double near = (b.y - kBrush) / kBrushWidth, dense = std::exp(-near * near);
  const double side = 0.5 * (1.0 + std::tanh(a[kX] / 0.02));  // 0 left, 1 right
  fy -= dense * (parameters[kLeft].value * (1.0 - side) + parameters[kRight].value * side) *
        std::fabs(std::cos(kPi * a[kX] / kHalfWidth));  // two gaps on each side
  fx += 0.3 * dense * std::sin(2.0 * kPi * a[kX] / kHalfWidth);
  if (coordinates > 3) {
    const double torque = 0.008 * push * noise.normal() + 0.02 * dense * a[kX] / kHalfWidth -
                          kTurnDrag * a[kTurn] - kUpright * a[kHeading];
    a[kTurn] += kStep * torque / kInertia;
    a[kHeading] += kStep * a[kTurn];
    fx += thrust * std::sin(a[kHeading]);
    fy += thrust * (std::cos(a[kHeading]) - 1.0);
  }
  a[kVx] += kStep * fx / kMass;
  a[kVy] += kStep * fy / kMass;
  a[kX] += kStep * a[kVx];
  b.y += kStep * a[kVy];
}

void describe(int coordinates) {
  const char* all[] = {
      R"("d","unit":"m","scale":0.01)",         R"("vx","unit":"m s-1","scale":0.1)",
      R"("vy","unit":"m s-1","scale":0.1)",     R"("heading","unit":"rad","scale":0.2)",
      R"("turn","unit":"rad s-1","scale":1.0)", R"("phase","unit":"1","scale":0.1)",
      R"("stride","unit":"1","scale":0.1)",     R"("load","unit":"1","scale":0.1)"};
  std::printf(R"({"gatewalk":1,"coordinates":[)");
  for (int i = 0; i < coordinates; ++i) std::printf(R"(%s{"name":%s})", i > 0 ? "," : "", all[i]);
  std::printf(R"(],"faces":[{"name":"S","move":[0,1]},{"name":"L","move":[1,0]},)"
              R"({"name":"R","move":[-1,0]},{"name":"N","move":[0,-1]}],)"
              R"("costs":[{"key":"time_s","unit":"s"}],"symmetric":false,"parameters":{)");
  for (const Parameter& p : parameters)
    std::printf(R"(%s"%s":[%g,0,10])", &p == parameters ? "" : ",", p.key, p.value);
  std::printf("}}\n");
  std::fflush(stdout);
}

}  // namespace
int main(int argc, char** argv) {
  const int coordinates = argc > 1 ? std::atoi(argv[1]) : 5;
  if (coordinates != 3 && coordinates != 5 && coordinates != kMost) {
    std::fprintf(stderr, "legged_body: takes 3, 5 or 8 coordinates\n");
    return 1;
  }
  describe(coordinates);
  static char line[4096];
  while (std::fgets(line, sizeof line, stdin) != nullptr) {
    if (line[0] == '\n') {
      std::fflush(stdout);
      continue;
    }
    const char* word = std::strtok(line, " \n");
    if (std::strcmp(word, "set") == 0) {
      const char *key = std::strtok(nullptr, " \n"), *value = std::strtok(nullptr, " \n");
      for (Parameter& p : parameters)
        if (std::strcmp(p.key, key) == 0) p.value = std::atof(value);
      continue;
    }
    const char face = *std::strtok(nullptr, " \n");
    Body b;
    for (int i = 0; i < coordinates; ++i) b.at[i] = std::atof(std::strtok(nullptr, " \n"));
    Noise noise{std::strtoull(std::strtok(nullptr, " \n"), nullptr, 10)};
    if (face == 'N') b.y = kLength;
    if (face == 'L' || face == 'R')
      b.y = std::exchange(b.at[kX], face == 'L' ? -kHalfWidth : kHalfWidth);
    double time = 0.0;
    const char* to = nullptr;
    for (; time < kMostTime && to == nullptr; time += kStep) {
      step(b, coordinates, noise);
      if (std::fabs(b.at[kX]) > kHalfWidth)
        to = b.at[kX] > 0.0 ? "L" : "R";
      else if (b.y >= kLength || b.y < 0.0)
        to = b.y < 0.0 ? "N" : "S";
    }
    if (to == nullptr) {
      std::printf("%s trapped %.17g\n", word, time);
      continue;
    }
    if (*to == 'L' || *to == 'R') b.at[kX] = b.y;
    std::printf("%s left %s", word, to);
    for (int i = 0; i < coordinates; ++i) std::printf(" %.17g", b.at[i]);
    std::printf(" %.17g -\n", time);
  }
}

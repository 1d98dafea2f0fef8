#pragma once

#include "drivers/simulation/ceiling.hpp"
#include "maps/camera_model.hpp"

// Where rays meet the ceiling, and how lights shine on it.
namespace lodestar {

/// The ray through a pixel. Outside the domain of the lens model (corners of a circular image) the pinhole
/// ray is used.
Vec3 ray_through(const Vec2& pixel, const CameraModel& camera);

/// Intersection of a ray with the ceiling; a nearly horizontal ray is cut off at a distance.
Vec2 meet_ceiling(const Vec3& from, const Vec3& ray, double height_m);

/// Light on the ceiling beside a tube or lamp.
struct Glow {
  double gray = 28.0;     ///< directly beside it
  double reach_m = 0.13;  ///< distance at which it has fallen to a quarter
};

/// The sum of all lights' glow at a point of the ceiling.
double glow_of_lights(const Ceiling& ceiling, const Vec2& point, const Glow& glow = {});

/// The tubes and lamps whose glow may be seen within a radius of a point.
Ceiling lights_near(const Ceiling& ceiling, const Vec2& middle, double radius_m);

}  // namespace lodestar

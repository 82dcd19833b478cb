#pragma once
// A frame of a run as a picture, drawn by POV-Ray.
#include <array>
#include <string>

namespace dem {

enum class ColourBy { material, speed, coordination, force };

struct PictureOptions {
  std::array<double, 3> from{-1.0, -2.0, 1.2};  ///< direction in which the camera stands; z is up
  ColourBy by = ColourBy::material;
  int width = 1000, height = 700;  ///< px
};

/// The scene of a frame (dem/run/frame_file.hpp) in POV-Ray's language: spheres opaque, moving bodies nearly so,
/// resting ones like glass. Colours other than by material run from blue to yellow over the values of 1 to 99 % of the
/// spheres. Throws data::InputError (65, 66) when the file is no frame.
std::string povray_scene(const std::string& frame, const PictureOptions& options);

/// Has POV-Ray draw the frame as a PNG file. Throws data::InputError: 69 POV-Ray is missing or fails, 73 cannot be
/// written.
void draw_frame(const std::string& frame, const std::string& png, const PictureOptions& options);

}  // namespace dem

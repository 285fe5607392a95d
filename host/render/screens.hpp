#pragma once

#include "luciole/gbuffer.hpp"
#include "luciole/image.hpp"
#include "raster/view.hpp"
#include "render/ready_picture.hpp"

// Screens change the colours of lit pixels by what is around them: RenderSettings::screens.
namespace luciole {

/// The groups of planes that screens name. One that only a comment names isn't read.
struct ScreenGroups {
  bool from_eye = false, depth = false, normal = false, object = false, material = false;
};
ScreenGroups groupsOf(const std::vector<ScreenProgram>& screens);

/// Floats that a pixel takes for screens in a picture of so many samples, about.
std::size_t screenFloats(const std::vector<ScreenProgram>& screens, int samples);

/// The part of a picture to draw for what `view` shows: with the neighbours that all screens together look
/// at, as far as the picture goes. Where the pixels of a tile share light it is all tiles of the picture that
/// hold these, so that every band has the same light.
View withMargin(const View& view, const PicturePlan& plan);

/// Planes r g b of a part of a picture, laid out as ScreenFrame says.
struct ScreenedColors {
  ScreenFrame frame = {};
  RawArray<float> color = {};
};

/// Applies the plan's screens, one after another, to a lit G-buffer. color: its light r g b before exposure.
/// inner: its pixels without the margin. Returns the colours after exposure. Adds to the statistics the time,
/// and for each screen the pixels of `inner` whose colours were none. Throws MachineError, and InputError
/// where a screen reads beyond its radius.
ScreenedColors applyScreens(ReadyPicture& picture, const GBuffer& gbuffer, const Plane& color,
                            const PixelRectangle& inner);

/// Sets R G B of the part's image to the mean of so many samples. sum: of their colours.
void setScreenedColors(const ScreenedColors& sum, int samples, Image& image);

}  // namespace luciole

// A screen: colours that a function of one's own makes of lit ones and of what is seen around each pixel.
#include "screens/screen.clh"
#include "user_text.clh"

// Without a text colours stay as they are.
#ifndef HAS_SCREEN
INLINE vec3L __screen_0(const Screen* at) { return color_at(at, 0, 0); }
#endif

// Whether a colour can't be shown: NaN, infinite or below 0.
INLINE intL is_no_color(floatL c) { return !(c >= 0.0f && c <= 3.4028235e38f); }

// image: the screen's colours, or those before it where these are none; laid out as `color`. A work-item
// makes LANES pixels of a row. marks: the pixels within frame's inner rectangle whose colour was none are
// added to marks[0]; the least note_beyond() of all goes to marks[1].
KERNEL void screen_rows(ScreenFrame frame, __global const float* color, __global const float* from_eye,
                        __global const float* depth, __global const float* normal, __global const int* object,
                        __global const int* material, __global float* image, __global uint* marks) {
  int blocks = (frame.columns + LANES - 1) / LANES, item = (int)work_item();
  int row = item / blocks, column = item % blocks * LANES;
  if (row >= frame.rows) return;
  int first = row * frame.row_stride + kScreenPad + column;
  uint beyond = 0xffffffff;
  ScreenRows rows = {color + first,
                     from_eye + first,
                     depth + first,
                     normal + first,
                     object + first,
                     material + first,
                     frame.plane_stride,
                     frame.row_stride,
                     row,
                     frame.rows - 1 - row,
                     frame.pixel_base,
                     frame.pixel_slope,
                     frame.eye,
                     frame.to_eye,
                     &beyond};
  Screen at = {column + frame.first_x + LANE_NUMBERS, (intL)(row + frame.first_y), frame.width, frame.height,
               &rows};
  vec3L before = color_of(&at, 0), after = __screen_0(&at);
  intL is_none = is_no_color(after.x) | is_no_color(after.y) | is_no_color(after.z);
  __global float* out = image + first;
  store_lanes(out, is_none ? before.x : after.x);
  store_lanes(out + frame.plane_stride, is_none ? before.y : after.y);
  store_lanes(out + 2 * frame.plane_stride, is_none ? before.z : after.z);
  // Beyond the part's edges rows go on as they end.
  for (uint plane = 0; plane < 3 && column == 0; ++plane) {
    __global float* begin = out + plane * frame.plane_stride;
    for (int i = 1; i <= kScreenPad; ++i) begin[-i] = begin[0];
  }
  int left = frame.columns - column;
  for (uint plane = 0; plane < 3 && left <= LANES; ++plane) {
    __global float* end = out + plane * frame.plane_stride + left;
    for (int i = 0; i < frame.row_stride - kScreenPad - frame.columns; ++i) end[i] = end[-1];
  }
  if (any_lane(is_none) && row >= frame.inner_top && row < frame.inner_bottom) {
    intL place = column + LANE_NUMBERS;
    uint bits = lane_bits(is_none & (place >= frame.inner_left) & (place < frame.inner_right));
    atomic_add(marks, popcount(bits));
  }
  if (beyond != 0xffffffff) atomic_min(marks + 1, beyond);
}

// The plain way to shade, which the benchmark holds shade.cl against: one pixel a work-item, vectors of
// three, built-in functions. Point lights with a smooth range window, Phong's highlights, all lights on all
// pixels.
#include "shared.h"

// A pixel's values lie in one float4 each: position and normal in view space; diffuse rgb; specular rgb and
// the exponent.
__kernel void plain(__global const float4* position, __global const float4* normal,
                    __global const float4* diffuse, __global const float4* specular,
                    __global const ShadeLight* lights, uint light_count, __global float4* image) {
  size_t pixel = get_global_id(1) * get_global_size(0) + get_global_id(0);
  float3 p = position[pixel].xyz;
  float3 n = normal[pixel].xyz;
  float3 to_eye = normalize(-p);
  float4 ks = specular[pixel];
  float3 diffuse_sum = 0.0f, specular_sum = 0.0f;
  for (uint i = 0; i < light_count; ++i) {
    float3 way = lights[i].position.xyz - p;
    float d2 = dot(way, way);
    float3 to_light = normalize(way);
    float ratio2 = d2 * lights[i].position.w;
    float window = max(1.0f - ratio2 * ratio2, 0.0f);
    float strength = window * window;
    float n_dot_l = dot(n, to_light);
    if (n_dot_l > 0.0f) {
      float3 mirrored = 2.0f * n_dot_l * n - to_light;
      float highlight = pow(max(dot(mirrored, to_eye), 0.0f), ks.w);
      diffuse_sum += strength * n_dot_l * lights[i].diffuse.xyz;
      specular_sum += strength * highlight * lights[i].specular.xyz;
    }
  }
  image[pixel] = (float4)(diffuse_sum * diffuse[pixel].xyz + specular_sum * ks.xyz, 1.0f);
}

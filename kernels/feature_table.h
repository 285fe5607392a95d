// The table of what a program may compile, shared by host and kernels: X(name in the host's code, name in
// kernels, as --stats shows it, what the compiled code does, which other kernels than those that shade depend
// on it: FeatureUse in host/shade/features.hpp). MODEL is called for each row of models.h.
#ifndef LUCIOLE_FEATURES_H
#define LUCIOLE_FEATURES_H

#include "models.h"

#define EACH_FEATURE(X, MODEL)                                                                               \
  X(PointLights, POINT_LIGHTS, "point lights", "lights with a place", 0)                                     \
  X(DirectionalLights, DIRECTIONAL_LIGHTS, "directional lights", "lights with a direction only", 0)          \
  X(SpotLights, SPOT_LIGHTS, "spot lights", "lights with a place and a cone", 0)                             \
  X(SpotExponent, SPOT_EXPONENT, "spot exponent", "OpenGL's cosine power inside a spot", 0)                  \
  X(SpotCone, SPOT_CONE, "spot cone", "glTF's ramp between two cones", 0)                                    \
  X(Profiles, PROFILES, "profiles", "luminaires with a profile of their light", 0)                           \
  X(Attenuation, ATTENUATION, "attenuation", "constant, linear and quadratic attenuation", 0)                \
  X(SmoothWindow, SMOOTH_WINDOW, "smooth window", "ranges that fade as (1 - (d/r)^4)^2", 0)                  \
  X(KhrWindow, KHR_WINDOW, "KHR window", "ranges that fade as 1 - (d/r)^4", 0)                               \
  X(Specular, SPECULAR, "specular", "highlights", 0)                                                         \
  EACH_MODEL(MODEL)                                                                                          \
  X(Ambient, AMBIENT, "ambient", "ambient reflection", 0)                                                    \
  X(LightAmbient, LIGHT_AMBIENT, "light ambient", "ambient light of single lights", 0)                       \
  X(Emission, EMISSION, "emission", "surfaces that glow", 0)                                                 \
  X(ParallelShadows, PARALLEL_SHADOWS, "parallel shadows", "shadow maps of directional lights", kForLookups) \
  X(PerspectiveShadows, PERSPECTIVE_SHADOWS, "perspective shadows", "shadow maps of narrow spots",           \
    kForLookups)                                                                                             \
  X(CubeShadows, CUBE_SHADOWS, "cube shadows", "shadow maps of point lights and wide spots", kForLookups)    \
  X(Pcf, PCF, "PCF", "filtered shadow lookups", 0)                                                           \
  X(Soft, SOFT, "soft shadows", "shadow lookups as wide as the light's size makes them", 0)                  \
  X(Exact, EXACT, "exact shadows", "shadows known for each pixel and light beforehand", kForBeams)           \
  X(SoftExact, SOFT_EXACT, "soft exact shadows", "exact shadows of samples of lights of a size", kForBeams)  \
  X(Holes, HOLES, "holes", "textures with holes, through which light shines", kForBeams | kForSampling)      \
  X(Lift, LIFT, "lifted shadows", "shadow tests that start on the smooth surface above a facet",             \
    kForLookups | kForBeams | kForSampling)                                                                  \
  X(NormalMaps, NORMAL_MAPS, "normal maps",                                                                  \
    "lights behind a surface, which a bent normal may face, are not seen", kForSampling)                     \
  X(FogLinear, FOG_LINEAR, "linear fog", "(end - z) / (end - start)", kForFog | kForClusters | kForSampling) \
  X(FogExp, FOG_EXP, "exp fog", "exp(-density z)", kForFog | kForClusters | kForSampling)                    \
  X(FogExp2, FOG_EXP2, "exp2 fog", "exp(-(density z)^2)", kForFog | kForClusters | kForSampling)             \
  X(FogPerChannel, FOG_PER_CHANNEL, "fog per channel", "a density for each colour channel",                  \
    kForFog | kForClusters | kForSampling)                                                                   \
  X(FogRadial, FOG_RADIAL, "radial fog", "fog by distance instead of depth",                                 \
    kForFog | kForClusters | kForSampling)                                                                   \
  X(ParallelView, PARALLEL_VIEW, "parallel view", "an orthographic camera's constant view vector",           \
    kForClusters | kForSampling)                                                                             \
  X(LightLists, LIGHT_LISTS, "light lists",                                                                  \
    "lists of the lights that matter to a few pixels, instead of all lights", kForLookups | kForBeams)       \
  X(LongSums, LONG_SUMS, "long sums", "more lights than float adds up one by one", 0)                        \
  X(OutputShadow, OUTPUT_SHADOW, "shadow layer", "the visible share of shadowed lights as an output", 0)     \
  X(ClusteredLights, CLUSTERED_LIGHTS, "clustered lights",                                                   \
    "clusters that stand for lights, with a bound of the error", kForClusters)                               \
  X(ClusteredHighlights, CLUSTERED_HIGHLIGHTS, "clustered highlights",                                       \
    "highlights of clusters that stand for lights", kForClusters)                                            \
  X(SampledLights, SAMPLED_LIGHTS, "sampled lights",                                                         \
    "lights with shadows that are sampled, with an interval of the error", kForSampling)                     \
  X(SampledHighlights, SAMPLED_HIGHLIGHTS, "sampled highlights", "highlights of lights that are sampled",    \
    kForSampling)                                                                                            \
  X(SampledDirections, SAMPLED_DIRECTIONS, "sampled directions",                                             \
    "directional lights that are sampled, apart from those with a place", kForSampling)                      \
  X(SampledLobes, SAMPLED_LOBES, "sampled lobes", "sampled lights that shine by the cosine to an axis",      \
    kForSampling)                                                                                            \
  X(WideHighlights, WIDE_HIGHLIGHTS, "wide highlights",                                                      \
    "highlights as wide as what a surface sees of the part of a source that a light stands for",             \
    kForSampling)                                                                                            \
  X(MaterialModels, MATERIAL_MODELS, "material models", "surfaces with models of their own", 0)              \
  X(UserModels, USER_MODELS, "user models", "models from files of the user's", 0)                            \
  X(Tangents, TANGENTS, "surface tangents", "models that reflect differently along and across a surface", 0)

#endif

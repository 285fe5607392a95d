#!/usr/bin/env python3
"""mutate_kernels.py [--build FOLDER] [--jobs N] [--sample N] [FILE…]: makes small mistakes in the kernels, one at a time, and tells which of
them the tests find. FILE: only the mutants of that kernel file. --sample N: only N of them, spread evenly over the files.

No file is touched and nothing is built: a preloaded library (mutate_kernels.c) hands OpenCL the sources with one line changed.
The tests must have been built from the kernels as they are (./luciole test, or ninja -C build).

Of each mutant the verdict is one of
  killed   by the test named
  LIVED    no test fails
  same     no test fails, nor could any: the table says why
  broken   it doesn't compile, and counts for nothing
  unseen   no test compiled it, and counts for nothing
Exit status: 0; 1 where a mutant lived, is broken or unseen, or one that is called the same was killed; 2 where the table or the
build doesn't fit the kernels, or a test fails without any mutant.
"""
import argparse
import concurrent.futures
import dataclasses
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent

# Which tests look for the mutants of a file, the quickest first: (program, filter of GoogleTest).
MATH = ("kernels", "MathKernels.*-*AreRefused")
FALLOFF = ("kernels", "FalloffKernels.*")
FOG = ("kernels", "FogKernels.*")
PHONG = ("kernels", "PhongKernels.*")
COOK_TORRANCE = ("kernels", "CookTorranceKernel.*")
WIDE = ("render", "*WideHighlights.*/16:WideHighlight.*")
WARD = ("kernels", "WardKernel.*")
OREN_NAYAR = ("kernels", "OrenNayarKernel.*")
MODELS = ("pictures", "*MaterialModels.LightEach*")
TOON = ("kernels", "ToonKernels.*")
DISC = ("kernels", "DiscKernels.*")
EXACT_SIGN = ("kernels", "ExactSignKernels.*")
SHADOW = ("kernels", "ShadowKernels.*")
CULL = ("kernels", "*CullKernels.*")
SHADE = ("kernels", "*ShadeKernel.*/16")
SHADE_TILES = ("shade", "*ShadeTiles.*/16:ShadeTiles.*")
CLOSED_FORM = ("pictures", "ClosedForm.*")
PICTURES = ("render", "Render.AgreesWith*:Render.ListLength*:Render.*LayerC*:Render.ShadowLayer*:Render.UnlitScene*")
EXACT = ("pictures", "Exact.CullingChangesNoBitOfAFloor*:Exact.CullingChangesNoBitUnder*:Exact.LightsThatAddNothing*")
HARD_SPOTS = ("pictures", "HardLights.SpotOf*")
SUMS = ("pictures", "HardLights.Million*")
NUMBERS = ("pictures", "HardNumbers.*:HardLobe*")
NEEDED = ("maps", "FindNeeded.*")
MAPS = ("maps", "ShadowMaps.*:*HoveringSquare*")
SOFT = ("exact", "*SoftEdge*")
EXACT_SHADOWS = ("pictures", "*ShadowMethods.PictureIsTheSame*/Exact")
BEAMS = ("exact", "BeamShadows.*")
LIGHT_RAYS = ("exact", "LightRays.*")
SOFT_BEAMS = ("exact", "SoftExact.AgreeWith*")
PAIR_RAYS = ("exact", "PairRays.*")
SOFT_PICTURES = ("pictures", "*ShadowMethods.PictureIsTheSame*/SoftExact:SoftExact.Of*")
FAR_FIELD = ("kernels", "FarFieldKernels.*")
HORIZON = ("kernels", "HorizonKernels.*")
CUT_CLUSTERS = ("kernels", "CutClusterKernels.*")
HIGHLIGHTS = ("kernels", "*HighlightKernels.*/16")
SHINY = ("shade", "*ClusteredLight.OfHighlights*/16")
CLUSTERED = ("shade", "ClusteredLights.*:HardClusteredLight.*-*AllNearTheHorizon")
AFTER_DARK = ("render", "LightError.PixelsAfter*")
TERMINATOR = ("pictures", "*Terminator*")
SAMPLED = ("kernels", "SampledKernels.*")
FEW_SAMPLED = ("pictures", "LightConfidence.OfFew*")
CALIBRATED = ("pictures", "LightConfidence.Holds*")
HARD_SAMPLED = ("pictures", "HardLightConfidence.*")
SAMPLED_PICTURES = ("render", "SampledLight.*")

TESTS = {
    "exact/beam.clh": [BEAMS, SOFT_BEAMS, EXACT_SHADOWS],
    "exact/beam_points.clh": [BEAMS, EXACT_SHADOWS, TERMINATOR],
    "exact/beam_shadows.cl": [BEAMS, SOFT_BEAMS, EXACT_SHADOWS],
    "exact/candidates.clh": [BEAMS, SOFT_BEAMS, EXACT_SHADOWS],
    "exact/blockers.clh": [BEAMS, SOFT_BEAMS, EXACT_SHADOWS],
    "clusters/clustered_light.cl": [SHINY, CLUSTERED, AFTER_DARK],
    "shade/cook_torrance.clh": [COOK_TORRANCE, PICTURES],
    "lights/count_in_range.cl": [PICTURES, EXACT],
    "lights/cull.cl": [CULL, EXACT, PICTURES],
    "clusters/cut_clusters.clh": [CUT_CLUSTERS, CLUSTERED],
    "maps/disc.clh": [DISC],
    "exact/exact_sign.h": [EXACT_SIGN],
    "shade/falloff.clh": [FALLOFF, HARD_SPOTS, CLOSED_FORM, SHADE],
    "clusters/far_field.clh": [FAR_FIELD, CLUSTERED],
    "maps/find_needed.cl": [NEEDED, MAPS],
    "shade/fog.clh": [FOG, CLOSED_FORM, PICTURES],
    "clusters/highlights.clh": [HIGHLIGHTS, SHINY],
    "exact/hole_masks.clh": [("pictures", "HoleMasks.*")],
    "exact/light_rays.cl": [LIGHT_RAYS],
    "exact/light_samples.h": [PAIR_RAYS, SOFT_PICTURES],
    "exact/open_pairs.cl": [PAIR_RAYS, EXACT_SHADOWS, SOFT_PICTURES, ("pictures", "HoleMasks.*")],
    "exact/pair_rays.cl": [PAIR_RAYS, SOFT_PICTURES],
    "exact/ray_starts.cl": [LIGHT_RAYS],
    "exact/ray_walk.clh": [LIGHT_RAYS],
    "exact/rays.clh": [LIGHT_RAYS],
    "exact/sample_rays.clh": [PAIR_RAYS, SOFT_PICTURES],
    "lanes.clh": [MATH, FALLOFF, PHONG, SHADE, NEEDED],
    "clusters/light_clusters.clh": [HORIZON, FAR_FIELD, CLUSTERED],
    "lights/light_tree.clh": [CULL, EXACT, PICTURES, SHADE_TILES],
    "clusters/listed_highlights.clh": [HIGHLIGHTS, SHINY],
    "clusters/lobe_series.clh": [HIGHLIGHTS, SHINY],
    "clusters/lobes.clh": [HIGHLIGHTS, SHINY],
    "long_sum.clh": [SUMS, EXACT],
    "math.clh": [MATH, SHADOW, PICTURES, TERMINATOR],
    "maps/pair_visibility.cl": [("bench", "*HardShadows*:ShadowErrors.DontDepend*")],
    "shade/phong.clh": [PHONG, CLOSED_FORM, NUMBERS],
    "shade/shade.cl": [CLOSED_FORM, SHADE, PICTURES, SUMS, EXACT, EXACT_SHADOWS],
    "shade/shade_tiles.cl": [SHADE_TILES, SHADE, EXACT],
    "shade/shading.clh": [CLOSED_FORM, SHADE, PICTURES, MODELS, SUMS, EXACT, EXACT_SHADOWS, SOFT_PICTURES],
    "maps/shadow.clh": [SHADOW, NEEDED, MAPS, SOFT, TERMINATOR],
    "shade/oren_nayar.clh": [OREN_NAYAR],
    "random.clh": [SAMPLED],
    "sampled/cut.clh": [SAMPLED, SAMPLED_PICTURES],
    "sampled/sampled_group.clh": [SAMPLED, FEW_SAMPLED, SAMPLED_PICTURES, CALIBRATED],
    "sampled/sampled_light.cl": [FEW_SAMPLED, SAMPLED_PICTURES, CALIBRATED, HARD_SAMPLED],
    "sampled/strata.clh": [SAMPLED, FEW_SAMPLED],
    "shade/toon.clh": [TOON],
    "shade/ward.clh": [WARD],
    "shade/wide_lobe.clh": [WIDE],
    "exact/wide_integer.h": [EXACT_SIGN],
}


@dataclasses.dataclass
class Mutant:
    """A change of one line. `old` stands once in the file; `same`: why no picture changes by it."""
    old: str
    new: str
    same: str = ""


MUTANTS = {
    "lanes.clh": [
        Mutant("return a > b ? a : b", "return a < b ? a : b"),
        Mutant("as_intL(a) & 0x7fffffff", "a < 0.0f ? a : a"),
        Mutant("vec3L b) { return fma_lanes(a.z, b.z, fma_lanes(a.x, b.x, a.y", "vec3L b) { return fma_lanes(a.z, b.z, fma_lanes(a.x, b.x, -a.y"),
        Mutant("float4 b) { return fma_lanes(a.z, b.z, fma_lanes(a.x, b.x, a.y * b.y", "float4 b) { return fma_lanes(a.z, b.z, fma_lanes(a.x, b.x, a.y * b.x"),
        Mutant("load_lanes(p + 2 * plane_stride)", "load_lanes(p + plane_stride)"),
        Mutant("fma_lanes(color.y, weight", "fma_lanes(color.x, weight"),
        Mutant("a.z * s}", "a.y * s}"),
        Mutant("(floatL)(0.0f)), (floatL)(1.0f))", "(floatL)(0.0f)), (floatL)(2.0f))"),
        Mutant("return __builtin_reduce_or(v)", "return __builtin_reduce_and(v)"),
        Mutant("return fold(v2.x, v2.y);", "return v2.x;"),
        Mutant("return __builtin_reduce_min(v)", "return __builtin_reduce_max(v)"),
    ],
    "math.clh": [
        Mutant("fma_lanes(x * y, y, (floatL)(-1.0f))", "x * y * y - 1.0f"),
        Mutant("0.375352979f", "0.375372979f"),
        Mutant("0x5f310000", "0x5f390000"),
        Mutant("exp2_from(-125.0f, a, b)", "exp2_from(-129.0f, a, b)"),
        Mutant("exponent == 0 ? f : m - 1.0f", "m - 1.0f"),
        Mutant("x > 0.0f ? result : (floatL)(-1e9f)", "x > 0.0f ? result : (floatL)(1e9f)"),
        Mutant("bits >> 23", "bits >> 22"),
        Mutant("as_intL(shifted) << 23", "as_intL(shifted) << 22"),
        Mutant("1.44269504f", "1.4426953f"),
        Mutant("0.055503417f", "0.055513417f"),
        Mutant("c <= -3.4028235e38f", "c >= -3.4028235e38f"),
        Mutant("y < 0.0f ? y - fold : y + fold", "y < 0.0f ? y + fold : y - fold"),
        Mutant("packed << 16 >> 16", "packed & 0xffff"),
    ],
    "exact/exact_sign.h": [
        Mutant("0x1.0001p-50 *", "0x1.0001p-51 *"),
        Mutant("0x1.0001p-50 *", "0.0 *"),
        Mutant("flushed = 0x1p-72", "flushed = 0.0"),
        Mutant("Ay * (Bz * Cx + Bx * Cz)", "Ay * (Bz * Cx - Bx * Cz)"),
        Mutant("return x > -x ? x : -x", "return x"),
        Mutant("return determinant_sign_by_integers(a, b, l, c, m)", "return 0"),
        Mutant("determinant < -bound", "determinant < bound"),
        Mutant("3 * ((bits) + 1) + 3 + 1", "3 * (bits) + 3 + 1"),
        Mutant("((bits) + 31) / 32", "((bits) + 31) / 32 - 1"),
        Mutant("greatest - least + 24", "greatest - least + 8"),
        Mutant("if (bits << 1 != 0 && exponent < least)", "if (exponent < least)",
               "zeros make the common unit smaller, and the integers longer"),
        Mutant("if (bits << 1 != 0 && exponent > greatest)", "if (exponent > greatest + 1)"),
        Mutant("if (greatest < least) return 0;", "", "without any bit the sum is 0 as well, in 26 words fewer"),
        Mutant("odd && row == 0", "odd && row == 3"),
        Mutant("odd ? 3 - row : row", "row"),
        Mutant("^ flip ^ 0x80000000", "^ flip"),
        Mutant("determinant_sign(a, b, l, c, l)", "determinant_sign(a, b, l, l, c)"),
        Mutant("return -determinant_sign(p, q, r, d, none)", "return determinant_sign(p, q, r, d, none)"),
    ],
    "shade/falloff.clh": [
        Mutant("fma_lanes(dz, dz, fma_lanes(dx, dx, (dy) * (dy)))", "fma_lanes(dx, dx, (dy) * (dy))"),
        Mutant("fma_lanes(-ratio2, ratio2, 1.0f)", "1.0f - ratio2"),
        Mutant("!light->khr_window", "light->khr_window"),
        Mutant("fma_lanes(a.z, d2", "fma_lanes(a.y, d2"),
        Mutant("a.y, d2 * inverse_d", "a.y, inverse_d"),
        Mutant("7.8886091e-31f", "7.8886091e-29f"),
        Mutant("cosine >= light->direction.w", "cosine > light->direction.w"),
        Mutant("* light->specular.w", "* light->diffuse.w"),
        Mutant("strength = ramp * ramp", "strength = ramp"),
        Mutant("-clamp01(1.0f - cosine)", "-0.5f * clamp01(1.0f - cosine)"),
        Mutant("cosine = -(dot3s", "cosine = (dot3s"),
    ],
    "shade/fog.clh": [
        Mutant("fog_end - distance", "fog_end + distance"),
        Mutant("exp_lanes(-(depth * depth))", "exp_lanes(-depth)"),
        Mutant("exp_lanes(-(density * distance))", "exp_lanes(density * distance)"),
        Mutant("fog_density.y", "fog_density.x"),
        Mutant("d2 * rsqrt_lanes(d2)", "rsqrt_lanes(d2)"),
        Mutant("fog_color.z", "fog_color.y"),
        Mutant("if (FOG_RADIAL && ", "if (FOG_RADIAL && !"),
    ],
    "shade/phong.clh": [
        Mutant("2.0f * dot3(v, normal)", "dot3(v, normal)"),
        Mutant("normal.y, -v.y", "normal.y, v.y"),
        Mutant("position.y, frame->eye.y", "position.y, -frame->eye.y", same="the eye's y is 0 in every view"),
        Mutant("position.x, frame->eye.x", "0.0f * position.x, frame->eye.x"),
        Mutant("to_light.y, inverse_d, to_eye.y", "to_light.y, inverse_d, -to_eye.y"),
        Mutant("-c, normal.z, fma", "c, normal.z, fma"),
        Mutant("fma_lanes(to_light.x, inverse_d, -", "(to_light.x - "),
        Mutant("fma_lanes(c, c, across2)", "fma_lanes(c, c, 0.0f * across2)"),
        Mutant("n_dot_l + n_dot_v, (floatL)(0.0f)", "n_dot_l + n_dot_v, (floatL)(-2.0f)"),
        Mutant("-0.5f * dot3(chord, chord)", "-0.4f * dot3(chord, chord)"),
    ],
    "shade/cook_torrance.clh": [
        Mutant("50.0f * f0", "40.0f * f0"),
        Mutant("fma_lanes(-0.25f,", "fma_lanes(-0.5f,"),
        Mutant("glance2 * glance2 * glance", "glance2 * glance2"),
        Mutant("fma_lanes(0.5f, shininess, 1.0f)", "fma_lanes(0.5f, shininess, 2.0f)"),
        Mutant("9.0949470e-13f", "9.0949470e-11f"),
        Mutant("fma_lanes(1.0f - alpha2", "fma_lanes(1.0f + alpha2"),
        Mutant("fma_lanes(-weight, fresnel, weight)", "weight"),
        Mutant("smith(max_lanes(n_dot_v, (floatL)(0.0f)), alpha2)", "smith(n_dot_v, alpha2)"),
        Mutant("fma_lanes(-0.5f, length2 * inverse, 1.0f)", "fma_lanes(-1.0f, length2 * inverse, 1.0f)"),
    ],
    "shade/oren_nayar.clh": [
        Mutant("fma_lanes(0.33f, shininess, 1.66f)", "fma_lanes(0.33f, shininess, 1.33f)"),
        Mutant("(floatL)(0.45f), fma", "(floatL)(0.9f), fma"),
        Mutant("fma_lanes(0.09f, shininess, 1.18f)", "fma_lanes(0.09f, shininess, 1.09f)"),
        Mutant("max_lanes(n_dot_l, n_dot_v), (floatL)(1e-30f)", "n_dot_v, (floatL)(1e-30f)"),
        Mutant("fma_lanes(-n_dot_l, n_dot_v,", "fma_lanes(-n_dot_l, n_dot_l,"),
        Mutant("roughness.retro * together * quotient_lanes(n_dot_l, larger)", "roughness.retro * together * n_dot_l"),
    ],
    "shade/toon.clh": [
        Mutant("32.0f * (x - edge)", "31.0f * (x - edge)"),
        Mutant("(lobe, 0.5f)", "(lobe, 0.49f)"),
        Mutant("(n_dot_l, 0.625f)", "(n_dot_l, 0.6f)"),
        Mutant("fma_lanes(0.25f, toon_step", "fma_lanes(0.26f, toon_step"),
    ],
    "shade/wide_lobe.clh": [
        Mutant("across2 + across2", "across2"),
        Mutant("(floatL)(2.0f), cosine, (floatL)(2.0f)", "(floatL)(2.0f), cosine, (floatL)(1.0f)"),
        Mutant("wide + offset, exponent + offset", "wide, exponent"),
    ],
    "shade/ward.clh": [
        Mutant("fma_lanes(0.5f, shininess, 1.0f)", "fma_lanes(0.5f, shininess, 2.0f)"),
        Mutant("0x1p40f", "0x1p36f"),
        Mutant("n_dot_l + max_lanes(n_dot_v, (floatL)(0.0f))", "n_dot_l + n_dot_v"),
        Mutant("(floatL)(0x1p-20f)", "(floatL)(0x1p-60f)"),
        Mutant("height * height", "height"),
        Mutant("(1.0f + tangent2) *", "tangent2 *"),
        Mutant("-1.4426950408889634f", "-1.0f"),
        Mutant("exp2_from(-63.0f,", "exp2_from(-8.0f,"),
        Mutant("max_lanes(n_dot_l, (floatL)(0.0f)) *", "n_dot_l *"),
        Mutant("fma_lanes(-along, normal.y, to_light.y + to_eye.y)", "to_light.y + to_eye.y"),
        Mutant("floatL along = n_dot_l + n_dot_v", "floatL along = n_dot_l"),
        Mutant("tangent2 * sharpness) * sharpness", "tangent2 * sharpness)"),
        Mutant("floatL least = 0x1p-20f", "floatL least = 0.0f"),
        Mutant("scaled_y = y * sharp_y", "scaled_y = y * sharp_x"),
        Mutant("fma_lanes(x, x, y * y)", "fma_lanes(x, x, 0.0f * y)"),
        Mutant("(sharp_x * sharp_y)", "(sharp_x * sharp_x)"),
    ],
    "long_sum.clh": [
        Mutant("x - (sum - *total)", "0.0f"),
        Mutant("sum.lost.y + block->y", "block->y"),
        Mutant("block->z = full ? zero : block->z", "block->z = block->z"),
        Mutant("full ? block->x : zero", "block->x"),
    ],
    "maps/disc.clh": [
        Mutant("{-0.159645f, 0.1462479f}", "{0.159645f, 0.1462479f}"),
        Mutant("{0.5365958f, -0.8345298f}", "{0.5365958f, 0.8345298f}"),
        Mutant("{0.2149088f, -0.9552913f}", "{0.2149088f, 0.9552913f}"),
    ],
    "shade/shade.cl": [
        Mutant("end - entry > kSumBlock", "end - entry >= kSumBlock",
               same="a single block of kSumBlock terms, moved to a total of 0, is that total to the bit"),
        Mutant("tile * frame.light_count + entry", "entry"),
        Mutant("squares & square[row]", "squares | square[row]",
               same="a light that a list leaves out adds nothing; this costs time alone"),
    ],
    "shade/shade_tiles.cl": [
        Mutant("extent, light)) << i * LANES", "extent, light)) << i"),
        Mutant("kByCone : kByCone | kByFacing", "kByCone | kByFacing : kByCone"),
        Mutant("1u << group % 32); bits", "2u << group % 32); bits"),
        Mutant("item % kBlockRun;", "item % 4;"),
        Mutant("if (block >= blocks) return;", "if (block > blocks) return;"),
        Mutant("step > 1 && candidates.count == kCandidates", "false"),
        Mutant("(block_y + tile / columns) * frame.tiles_x", "(block_y + tile / width) * frame.tiles_x"),
        Mutant("block % blocks_x * width", "block % blocks_x"),
        Mutant("task->begun || !task->last || count > kSumBlock", "count > kSumBlock"),
        Mutant("if (LIT && task->begun) row.sums = *kept;", ""),
        Mutant("task->lights + light[k]", "task->lights + light[0]"),
        Mutant("light = candidates->light[near[i]]", "light = near[i]"),
        Mutant("task.last = candidates.count < kCandidates", "task.last = true"),
        Mutant("in_reach + (task->begun ? counts[0] : 0)", "in_reach"),
    ],
    "shade/shading.clh": [
        Mutant("n_dot_l > 0.0f ?", "n_dot_l > -1.0f ?"),
        Mutant("n_dot_l < 2.0f ? n_dot_l : (floatL)(0.0f)", "n_dot_l"),
        Mutant("MODEL_IS(kBlinnPhongModel) ? halved : shininess", "shininess"),
        Mutant("pixels->model == (int)kBlinnPhongModel ? halved : shininess", "shininess"),
        Mutant("chosen > 0 ? chosen - 1 : (intL)((int)of_picture)", "chosen - 1"),
        Mutant("!IS_COMPILED(number) || !(models >> number & 1)", "!IS_COMPILED(number)", same="only work is saved"),
        Mutant("takes_it ? by_model[k].highlight : pairs[k].highlight", "by_model[k].highlight"),
        Mutant("takes_it ? by_model[k].grazing : pairs[k].grazing", "by_model[k].grazing"),
        Mutant("k < count ?", "k <= count ?"),
        Mutant("sums->fullest == kSumBlock", "sums->fullest == 2 * kSumBlock"),
        Mutant("sums->terms >= kSumBlock", "sums->terms > kSumBlock"),
        Mutant("pixels->covered ? finite_color(seen.y) : color.y", "finite_color(seen.y)"),
        Mutant("light.y += sums->part[kAmbientPart].y", "light.y += sums->part[kAmbientPart].x"),
        Mutant("seen.z += ke.z", "seen.z += ke.y"),
        Mutant("fma_lanes(visible, counted, pixels->visible)", "pixels->visible + visible"),
        Mutant("pixels->shadow_lights > 0.0f ? share : (floatL)(1.0f)", "share"),
        Mutant("pair->strength *= visible", "pair->strength = visible"),
        Mutant("all_lanes(frame->background)", "all_lanes(frame->ambient)"),
        Mutant("light->specular, pair->strength * pair->highlight", "light->diffuse, pair->strength * pair->highlight"),
        Mutant("kPairWords + pixels->place / 32", "kPairWords + pixels->place / 64"),
        Mutant("shadows->first_share[at] + popcount(below)", "shadows->first_share[at]"),
        Mutant("(uint)((1ul << LANES) - 1)", "(uint)((1ul << LANES) - 2)"),
        Mutant("finish_sum(sums->closed[part]", "finish_sum(sums->closed[kDiffusePart]"),
    ],
    "maps/shadow.clh": [
        Mutant("fma_lanes(-face.scale, v", "fma_lanes(face.scale, v"),
        Mutant("!point.inside & (x > face.low)", "(x > face.low)"),
        Mutant("to_point.x = negative ? -to_point.x : to_point.x", "to_point.x = to_point.x"),
        Mutant("normal.z = negative ? -normal.z : normal.z", "normal.z = normal.z"),
        Mutant("negative ? face + 1 : face", "face"),
        Mutant("on_y = ay >= az", "on_y = ay <= az"),
        Mutant("i == 0 ? 1.0f - fx", "i == 0 ? fx"),
        Mutant("j == PCF_WIDTH - 1 ? fy", "j == PCF_WIDTH - 1 ? 1.0f - fy"),
        Mutant("1.0f / ((PCF_WIDTH - 1) * (PCF_WIDTH - 1))", "1.0f / (PCF_WIDTH - 1)"),
        Mutant("texel.slopes << 16", "texel.slopes"),
        Mutant("convert_floatL(column) + 0.5f - point.x", "convert_floatL(column) - point.x"),
        Mutant("inverse_w, map->depth_offset)", "inverse_w, -map->depth_offset)"),
        Mutant("point.rise_y = -n.y * slope", "point.rise_y = n.y * slope"),
        Mutant("width * width >= away2", "width * width <= away2"),
        Mutant("-1e-5f * length", "1e-2f * length"),
        Mutant("1.00001f", "0.9f"),
        Mutant("fma_lanes(lift, n.y, p.y)", "fma_lanes(-lift, n.y, p.y)"),
        Mutant("fma_lanes(slope_x, from_x - offset_x", "fma_lanes(slope_x, from_x"),
        Mutant(", 0x1p-22f * point.depth", ", 0.0f",
               same="way.z / way.z is 1, so the other term is at least as large; no point of the tests errs by more than that one"),
        Mutant("POSITION_ROUNDING 0x1p-22f", "POSITION_ROUNDING 0x1p-40f"),
        Mutant("- point.rounding - tilt", "- point.rounding"),
        Mutant("LEAST_COSINE 0.002f", "LEAST_COSINE 0.2f"),
        Mutant("left = point.x - 0.5f * (PCF_WIDTH - 1)", "left = point.x - 0.5f * PCF_WIDTH"),
        Mutant("off ? (floatL)(0.0f) : lift", "lift"),
    ],
    "lights/cull.cl": [
        Mutant("p.z - middle.z}", "p.z}"),
        Mutant("-SLACK * sizes", "SLACK * sizes"),
        Mutant("SLACK 4e-6f", "SLACK 0.0f"),
        Mutant("(tests & kByCone) && ", ""),
        Mutant("first_squares << lowest_bit(rest) * squares_per_group", "first_squares << lowest_bit(rest)"),
        Mutant("room <= kFoundPerTile", "room <= 2 * kFoundPerTile"),
        Mutant("lit &= ~(1u << group)", "lit &= 1u << group"),
        Mutant("(1u << squares_per_group) - 1", "1u"),
    ],
    "lights/light_tree.clh": [
        Mutant("light->position.x - middle.x, light->position.y", "light->position.x + middle.x, light->position.y"),
        Mutant("node + 3 * stride", "node + 2 * stride"),
        Mutant("* inverse_range2 >= 1.0f", "* inverse_range2 >= 0.9f"),
        Mutant("(1u << nodes) - 1", "(2u << nodes) - 1"),
        Mutant("start += rows * kTreeArity", "start += nodes"),
        Mutant("if (cosine <= 0.0f)", "if (cosine <= -1.0f)",
               same="what a wide spot leaves dark is a cone too, to whose side the distance is the same; the lists are only shorter"),
        Mutant("* cosine - along * sine", "* cosine + along * sine"),
        Mutant("radius + 1e-3f * v2", "radius - 1e-3f * v2"),
        Mutant("max_lanes(high.y - middle->y, middle->y - low.y)", "high.y - middle->y"),
        Mutant("0.5f * low.y + 0.5f * high.y", "0.5f * low.y - 0.5f * high.y"),
        Mutant("gap(nodes.low.z,", "0.0f * gap(nodes.low.z,"),
        Mutant("grow_boxes(&points, tiles->boxes[i].high, narrow)", "grow_boxes(&points, tiles->boxes[i].low, narrow)"),
        Mutant("grow_boxes(&points, p, mask)", "grow_boxes(&points, p, p.z > 0.0f)"),
        Mutant("(GroupMask)(any_lane(mask) ? 1 : 0) << group", "(GroupMask)(any_lane(mask) ? 1 : 0)"),
        Mutant("reached = groups & ~wide", "reached = groups",
               same="a group of which no point is reached may count as reached; this costs time alone"),
        Mutant("return reached & groups", "return reached"),
        Mutant("d2 * place.w >= 1.0f", "d2 * place.w >= 0.9f"),
        Mutant("adds &= dot3(normal, from_light) < 0.0f", "adds &= dot3(normal, from_light) < -0.1f"),
        Mutant("from_light.y = position.y - place.y", "from_light.y = position.y + place.y"),
        Mutant("1.0f + 0x1p-20f", "1.0f - 0x1p-10f"),
        Mutant("&& cosine > 0.0f)", "&& cosine > -1.0f)"),
        Mutant("tested.placed = 0.0f", "tested.placed = 1.0f"),
    ],
    "exact/beam_points.clh": [
        Mutant("cluster->whole = whole", "cluster->whole = true"),
        Mutant("tile->pixel[to] = (uchar)(first_pixel + next)", "tile->pixel[to] = (uchar)(first_pixel + spare)"),
        Mutant("return scale3(turned(frame, p), (floatL)(frame->tree_scale))", "return turned(frame, p)"),
        Mutant("p.y = fma_lanes(lift, n.y, p.y)", "p.y = p.y"),
        Mutant("POINT_ERROR * ((abs_lanes(s.x) + abs_lanes(s.y)) + abs_lanes(s.z))", "0.0f * s.x"),
        Mutant("POINT_ERROR * (1.0f - 0x1p-20f) * least", "POINT_ERROR * (1.0f - 0x1p-20f) * most"),
        Mutant("POINT_ERROR * (1.0f + 0x1p-20f) * most", "0.0f"),
        Mutant("return lower & points;", "return lower;"),
    ],
    "exact/beam.clh": [
        Mutant("over > under ? 1.0f : -1.0f", "1.0f"),
        Mutant("beside = best * STEEPEST > largest", "beside = true"),
        Mutant("low < 0.0f ? -FARTHER : box->low[axis]", "box->low[axis]"),
        Mutant("high > 0.0f ? FARTHER : box->high[axis]", "box->high[axis]"),
        Mutant("lesser(box->low[axis], low)", "box->low[axis]"),
        Mutant("greater(box->high[axis], high)", "box->high[axis]"),
        Mutant("right -= ahead * view->slope[0]", "right -= 0.0f"),
        Mutant("r->u_low -= du", "r->u_low += du + 1e-2f * (r->u_high - r->u_low)"),
        Mutant("sign * away)", "0.0f)"),
        Mutant("k >= 0.0f ? 1 : 0", "k < 0.0f ? 1 : 0"),
        Mutant("view->sides = positive(coordinate(place, ahead)) > 1.25f * view->size", "view->sides = true"),
        Mutant("view->sides = best > 2.0f * view->size", "view->sides = true"),
        Mutant("has_size(view) ? d - view->size : d", "d"),
        Mutant("has_size(view) ? d + view->size : d", "d"),
        Mutant("u -= d > 0.0f ? sign * turn : -sign * turn", "u -= 0.0f"),
        Mutant("u -= d > 0.0f ? sign * turn : -sign * turn", "u -= sign * turn"),
        Mutant("away -= sign * turn * far", "away -= 0.0f"),
        Mutant("u += quotient(sign * more, far)", "u += quotient(2.0f * sign * more, far)"),
        Mutant("away = -sign * 1.00002f * more", "away = -sign * 0.5f * more"),
        Mutant("beam->radius = 1.00001f * square_root(beam->radius)", "beam->radius = 0.0f"),
        Mutant("view->axis[i])) : beam->across[i];", "view->axis[i])) : 0.0f;"),
        Mutant("beam->across[i] + beam->far : 0.0f", "0.0f : 0.0f"),
    ],
    "exact/blockers.clh": [
        Mutant("EDGE_ROUNDING (32.0f * 0x1p-24f)", "EDGE_ROUNDING 0.0f"),
        Mutant("SIDE_ROUNDING (18.0f * 0x1p-24f)", "SIDE_ROUNDING 0.0f"),
        Mutant("#define CLEAR 0x1p-21f", "#define CLEAR -1.0f"),
        Mutant("orientation(a, b, c, start) * side_of_light(blocks, reference, light) <= 0", "true"),
        Mutant("if (sign == -side) return false", "if (sign != side) return false"),
        Mutant("flip = as_intL(side) & (int)0x80000000", "flip = 0"),
        Mutant("-dot3(m, t->light)}", "dot3(m, t->light)}"),
        Mutant("m.z *= view->side", "m.z *= 1.0f"),
        Mutant("W = {t->V.x + beam->corner_far[0], t->V.y + beam->corner_far[1], t->V.z +", "W = {beam->corner_far[0], beam->corner_far[1], 0.0f * t->V.z +"),
        Mutant("meets &= height != 0.0f", "meets &= height > 0.0f"),
        Mutant("*in = most >= 0.0f", "*in = least >= 0.0f"),
        Mutant("*covers = least > 0.0f", "*covers = most > 0.0f"),
        Mutant("max_lanes(plane_rounding, (floatL)(bounds->most_tolerance))", "(floatL)(-1e30f)"),
        Mutant("covers &= clear & ~straddles", "covers &= ~straddles"),
        Mutant("covers &= clear & ~straddles", "covers &= clear",
               same="the light isn't clear of a plane whose triangle straddles it, but for what rounding does to their orientation"),
        Mutant("half_width += blur[i] * quotient(1.00001f, view->nearest)", "half_width += 0.0f"),
        Mutant("*in |= straddles & (reversed <= 0.0f)", "*in |= straddles & 0"),
        Mutant("inside >= 0.0f", "inside >= 1e-2f"),
        Mutant("lost + view->size * (1.00001f * length_bound(n)", "lost + view->size * (0.25f * length_bound(n)"),
        Mutant("out->blur[i] = 2.00002f * view->size", "out->blur[i] = view->size"),
        Mutant("length_bound(turned) + more", "length_bound(turned)"),
        Mutant("length_bound(turned) + more", "more"),
        Mutant("meets &= in | straddles", "meets &= in"),
        Mutant("- 1.00001f * view->size", "- 0.0f * view->size"),
    ],
    "exact/beam_shadows.cl": [
        Mutant("light->reach + tile->most_lift", "0.9f * light->reach"),
        Mutant("-1e-5f * length - tile->most_lift", "1e-2f * length"),
        Mutant("receives &= tile->used[row]", "receives &= 0xffff",
               same="places without a point repeat one, and are no pixel's"),
        Mutant("SOFT_EXACT && light.size > 0.0f, received", "SOFT_EXACT, received", same="counts for --stats alone, where lights have a size and others none"),
        Mutant("unsure[i] &= listed_pixels(squares, i);", "", same="the shares of pixels that aren't shaded are traced for nothing"),
        Mutant("of_word & 2 ? 0xffff0000u", "of_word & 1 ? 0xffff0000u"),
        Mutant("rest.stack[j] = walk.stack[j]", "rest.stack[j] = walk.stack[0]"),
        Mutant("masked[row] ^ keep", "masked[row]"),
        Mutant("lit |= remaining->left[row];", "lit |= 1u << lowest_bit(points);"),
    ],
    "exact/candidates.clh": [
        Mutant("lane_bits(least_edge(tile, c, at, point) > (floatL)(c->rounding[at]))", "lane_bits(least_edge(tile, c, at, point) >= (floatL)(-c->rounding[at]))"),
        Mutant(">= (floatL)(-c->rounding[at])", "> (floatL)(c->rounding[at])"),
        Mutant("lane_bits(least > rounding));", "lane_bits(least >= -rounding));"),
        Mutant("lane_bits(least >= -rounding) & bits >> i", "lane_bits(least > rounding) & bits >> i"),
        Mutant("height > max_lanes(lanes_at(tile->tolerance, point), (floatL)(c->plane_rounding[at]))", "height > lanes_at(tile->tolerance, point)"),
        Mutant("height > max_lanes((floatL)(tile->tolerance[point]), lanes_at(c->plane_rounding, first))", "height > lanes_at(c->plane_rounding, first)"),
        Mutant("inside & sure & clear", "inside & sure"),
        Mutant("clear ? inside & ~sure : inside", "inside & ~sure"),
        Mutant("~holes & c->clear[at / kTreeWidth]", "~holes"),
        Mutant("blur = c->blur[e][at] * (1.00001f * lanes_at(tile->nearness, point)) + rounding", "blur = rounding"),
        Mutant("1.00001f * lanes_at(tile->nearness, point)", "0.5f * lanes_at(tile->nearness, point)"),
        Mutant("part = beyond & (most >= 0.0f)", "part = beyond & (least >= 0.0f)"),
        Mutant("part |= (abs_lanes(height) > nearest) & ((most >= 0.0f) | (reversed <= 0.0f))", "part |= beyond"),
        Mutant("(most >= 0.0f) | (reversed <= 0.0f)", "most >= 0.0f"),
        Mutant("if (clear && !straddles) all", "if (!straddles) all"),
        Mutant("beyond & (least > 0.0f)", "beyond & (most > 0.0f)"),
        Mutant("remaining->unsure[row] |= (ushort)(partly & left)", "remaining->unsure[row] |= 0"),
        Mutant("if (holed) continue;", ""),
        Mutant("left |= remaining->left[row] & ~remaining->unsure[row]", "left |= remaining->left[row] & 0"),
        Mutant("beyond |= straddles", "beyond |= 0"),
        Mutant("all_beyond &= ~straddles", "all_beyond &= 1"),
    ],
    "maps/find_needed.cl": [
        Mutant("smallest_lane(mask ? y : none)", "smallest_lane(mask ? x : none)"),
        Mutant("row * (last + 1) + column", "row * last + column"),
        Mutant("depth >= last_noted->depth", "depth <= last_noted->depth"),
        Mutant("(int)face->bins - 1", "(int)face->bins - 2"),
        Mutant("receives &= point.inside", "receives |= point.inside",
               same="more texels are drawn than anybody looks at; this costs time alone"),
    ],
    "lights/count_in_range.cl": [
        Mutant("light->position.z - p.z", "light->position.z"),
        Mutant("light->kind != kDirectionalLight", "light->kind == kDirectionalLight"),
        Mutant("!(ratio2 >= 1.0f)", "!(ratio2 <= 1.0f)"),
    ],
    "maps/pair_visibility.cl": [
        Mutant("map_lookup(maps + map_of_row[row]", "map_lookup(maps"),
        Mutant("load_vec3(normal + first", "load_vec3(position + first"),
    ],
    "clusters/clustered_light.cl": [
        Mutant("COSINE_ROUNDING 5", "COSINE_ROUNDING 0"),
        Mutant("MOST_SHARE 0.0625f", "MOST_SHARE 1e30f"),
        Mutant("of_lights = 0x1p-24f * (float)(LIGHT_ROUNDING + kSumTerms + 4),", "of_lights = 0x1p-24f * (float)(LIGHT_ROUNDING + 4),"),
        Mutant("of_lights * lights[c] + COSINE_ROUNDING", "COSINE_ROUNDING"),
        Mutant("(high[c] - cut) + of_clusters", "of_clusters"),
        Mutant("field.term[kFieldBound] + field.rounding", "field.rounding"),
        Mutant("cosine = max_lanes(dot3(normal, u) * inverse_d, (floatL)(0.0f))", "cosine = dot3(normal, u) * inverse_d"),
        Mutant("add_vectors(&sums->weight, block_weight)", "sums->weight = block_weight"),
        Mutant("middle = 0.5f * low + 0.5f * high", "middle = low",
               same="a middle anywhere is right, as radius, spread and thickness are measured from it; bounds are only larger"),
        Mutant("group.radius = 1.00001f", "group.radius = 0.5f"),
        Mutant("group.spread = 1.00001f", "group.spread = 0.0f"),
        Mutant("group.thickness = thickness +", "group.thickness = 0.0f * thickness +"),
        Mutant("row * LANES) * transmittance[c]", "row * LANES)"),
        Mutant("tries == kMostTries) return", "true) return"),
        Mutant("tries == kMostTries) break", "true) break"),
        Mutant("lobes.rounding + of_lights * lights[c] + of_row->unsure", "lobes.rounding + of_row->unsure"),
        Mutant("of_row->unsure + of_row->rounding", "of_row->rounding"),
        Mutant("lobes.term[kLobeBound] +", ""),
        Mutant("lobes.rounding + of_lights", "of_lights"),
        Mutant("of_row->unsure + of_row->rounding", "of_row->unsure"),
        Mutant("group.turn = 1.00001f", "group.turn = 0.5f"),
        Mutant("(diffuse_light[3 + c][place] + of_bound", "(of_bound"),
        Mutant("== (floatL)(pixels->exponent)", ">= (floatL)(0.0f)"),
        Mutant("walk.lights = walk.clusters = 0;", "walk.lights = 0;"),
    ],
    "clusters/cut_clusters.clh": [
        Mutant("largest = abs_lanes(z0) + width", "largest = abs_lanes(z0) + 0.5f * width"),
        Mutant("largest = abs_lanes(z0) + width", "largest = width"),
        Mutant("coarse = 0x1p-19f *", "coarse = 0x1p-40f *"),
        Mutant("fma_lanes(lost[c], largest, fma", "fma_lanes(0.0f * lost[c], largest, fma"),
        Mutant("z0, z[c] + shift, across", "z0, z[c] - shift, across"),
        Mutant("z0, z[c] + shift, across", "z0, z[c], across"),
        Mutant("z[c] = fma_lanes(z0, (floatL)(q), shift)", "z[c] = fma_lanes(z0, (floatL)(q), -shift)"),
        Mutant("2.0f * normal.x * normal.y, 2.0f", "-2.0f * normal.x * normal.y, 2.0f"),
        Mutant("return y * fma_lanes(-x, y, (floatL)(2.0f))", "return y * fma_lanes(-x, y, (floatL)(2.02f))"),
        Mutant("(floatL)(3172.0f), (floatL)(462.0f)), (floatL)(252.0f)), (floatL)(126.0f)", "(floatL)(3172.0f), (floatL)(462.0f)), (floatL)(252.0f)), (floatL)(0.0f)"),
        Mutant("(floatL)(3172.0f), (floatL)(462.0f)), (floatL)(252.0f)), (floatL)(126.0f)", "(floatL)(0.0f), (floatL)(0.0f)), (floatL)(0.0f)), (floatL)(126.0f)"),
        Mutant("inverse_d, power[2], power[1]), power[0])", "inverse_d, 0.5f * power[2], power[1]), power[0])"),
        Mutant("inverse_d, power[2], power[1]), power[0])", "inverse_d, power[2], 0.5f * power[1]), power[0])"),
        Mutant("inverse_d, power[2], power[1]), power[0])", "inverse_d, power[2], power[1]), 0.5f * power[0])"),
        Mutant("{0.5f * fma_lanes(fourth * fourth", "{0.4f * fma_lanes(fourth * fourth"),
        Mutant("fma_lanes(3.0f * inverse_d, deviation", "fma_lanes(1.5f * inverse_d, deviation"),
        Mutant("abs_lanes(z[c]), fma_lanes", "abs_lanes(z[c]) + lost[c], fma_lanes"),
        Mutant("inverse_largest, -lost[c])) - lost[c]", "inverse_largest, -lost[c]))"),
        Mutant("half_rms = 0.5f *", "half_rms = 0.49f *"),
        Mutant("fma_lanes(z2[c], half_inverse_rms", "fma_lanes(0.5f * z2[c], half_inverse_rms"),
        Mutant("half_of_it = 0.5f *", "half_of_it = 0.4f *"),
        Mutant("factors.half_power, half_of_it)", "factors.half_power, 0.9f * half_of_it)"),
        Mutant("-factors.slant, most, least", "factors.slant, most, least"),
        Mutant("half_of_most, high[2]", "half_of_most, high[1]"),
    ],
    "clusters/far_field.clh": [
        Mutant("fma_lanes(at, q, 3.0f * h1), 3.0f * h2), h3)", "fma_lanes(at, q, 1.5f * h1), 3.0f * h2), h3)"),
        Mutant("fma_lanes(at, q, 3.0f * h1), 3.0f * h2), h3)", "fma_lanes(at, q, 3.0f * h1), 1.5f * h2), h3)"),
        Mutant("fma_lanes(at, q, 3.0f * h1), 3.0f * h2), h3)", "fma_lanes(at, q, 3.0f * h1), 3.0f * h2), 0.5f * h3)"),
        Mutant("fma_lanes(at, q, 3.0f * h1), 3.0f * h2), h3)", "fma_lanes(at, 0.5f * q, 3.0f * h1), 3.0f * h2), h3)"),
        Mutant("4.0f * h1), 6.0f * h2), 4.0f * h3), h4)", "2.0f * h1), 6.0f * h2), 4.0f * h3), h4)"),
        Mutant("4.0f * h1), 6.0f * h2), 4.0f * h3), h4)", "4.0f * h1), 3.0f * h2), 4.0f * h3), h4)"),
        Mutant("4.0f * h1), 6.0f * h2), 4.0f * h3), h4)", "4.0f * h1), 6.0f * h2), 2.0f * h3), h4)"),
        Mutant("4.0f * h1), 6.0f * h2), 4.0f * h3), h4)", "4.0f * h1), 6.0f * h2), 4.0f * h3), 0.5f * h4)"),
        Mutant("3.0f * a1), 3.0f * a2), a3)", "1.5f * a1), 3.0f * a2), a3)"),
        Mutant("3.0f * a1), 3.0f * a2), a3)", "3.0f * a1), 1.5f * a2), a3)"),
        Mutant("3.0f * a1), 3.0f * a2), a3)", "3.0f * a1), 3.0f * a2), 0.5f * a3)"),
        Mutant("(floatL)(-5.0f), k, (floatL)(6.0f)", "(floatL)(-5.0f), k, (floatL)(5.0f)"),
        Mutant(", room * room)", ", room)"),
        Mutant("fma_lanes(y, (floatL)(5.0f / 3), (floatL)(2.5f))", "fma_lanes(y, (floatL)(5.0f / 3), (floatL)(2.0f))"),
        Mutant("fma_lanes(y, (floatL)(5.0f / 3), (floatL)(2.5f))", "fma_lanes(y, (floatL)(0.8f), (floatL)(2.5f))"),
        Mutant("fma_lanes(y, (floatL)(1.875f), (floatL)(3.25f))", "fma_lanes(y, (floatL)(0.9f), (floatL)(3.25f))"),
        Mutant("fma_lanes(y, (floatL)(1.875f), (floatL)(3.25f))", "fma_lanes(y, (floatL)(1.875f), (floatL)(1.6f))"),
        Mutant("fma_lanes(y, (floatL)(0.3125f), (floatL)(0.7125f))", "fma_lanes(y, (floatL)(0.15f), (floatL)(0.7125f))"),
        Mutant("fma_lanes(y, (floatL)(0.3125f), (floatL)(0.7125f))", "fma_lanes(y, (floatL)(0.3125f), (floatL)(0.35f))"),
        Mutant("fma_lanes(rest * g.rest,", "fma_lanes(0.0f * rest * g.rest,"),
        Mutant("fma_lanes(g.degree3, degree3", "fma_lanes(0.5f * g.degree3, degree3"),
        Mutant("g.degree4 * inverse_d * degree4", "0.5f * g.degree4 * inverse_d * degree4"),
        Mutant("sum * d2 * d2 * inverse_d", "0.9f * sum * d2 * d2 * inverse_d"),
        Mutant("(floatL)(12.0f), k, (floatL)(4.0f)", "(floatL)(6.0f), k, (floatL)(4.0f)"),
        Mutant("(floatL)(12.0f), k, (floatL)(4.0f)", "(floatL)(12.0f), k, (floatL)(2.0f)"),
        Mutant("(float)(96 + kFieldBlock", "(float)(48 + kFieldBlock"),
        Mutant("+ sums->closed)", ")"),
        Mutant("96 + kFieldBlock + sums", "96 + sums"),
        Mutant("fma_lanes(share, error, term[kFieldBound])", "fma_lanes(0.5f * share, error, term[kFieldBound])"),
        Mutant("(floatL)(7.5f), ns, -1.5f * trace", "(floatL)(7.5f), ns, 1.5f * trace"),
        Mutant("(floatL)(7.5f), ns, -1.5f * trace", "(floatL)(-7.5f), ns, -1.5f * trace"),
        Mutant("d4, -3.0f * np * d3)", "d4, 3.0f * np * d3)"),
        Mutant("minus3_d4 = -3.0f * d4", "minus3_d4 = 3.0f * d4"),
        Mutant("both = -15.0f * npd4", "both = 15.0f * npd4"),
        Mutant("vec3L t = scale3(n, 3.0f * d3)", "vec3L t = scale3(n, -3.0f * d3)"),
        Mutant("alone = 3.0f * npd4", "alone = -3.0f * npd4"),
        Mutant("scale3(p, 3.0f * d4)", "scale3(p, -3.0f * d4)"),
        Mutant("fma_lanes(n.z, both, t.z), t.y * n.z", "fma_lanes(n.z, both, t.z), t.y * n.y"),
        Mutant("mixed = -1.5f * d4", "mixed = 1.5f * d4"),
        Mutant("cubic = 7.5f * d4", "cubic = -7.5f * d4"),
        Mutant("n.x * n.y * (cubic * n.z)", "n.x * n.y * (cubic * n.x)"),
        Mutant("term[kField2 + 6] = n.z * cy", "term[kField2 + 6] = n.z * cx"),
        Mutant("nzhz = n.z * h.z", "nzhz = -n.z * h.z"),
        Mutant("fma_lanes(n.x, h.z, n.z * h.x)", "fma_lanes(n.x, h.z, -n.z * h.x)"),
        Mutant("fma_lanes(n.y, xx, fma_lanes(n.x, xy, -yzz))", "fma_lanes(n.y, xx, fma_lanes(n.x, xy, yzz))"),
        Mutant("xy = 2.0f * h.x * h.y", "xy = h.x * h.y"),
        Mutant("fma_lanes(n.x, yz, fma_lanes(n.y, xz, n.z * xy))", "fma_lanes(n.x, yz, fma_lanes(n.y, xz, -n.z * xy))"),
        Mutant("total[i] += term[i]", "total[i] = term[i]"),
        Mutant("slot[k] += slot[k + other]", "slot[k] += slot[k]"),
        Mutant("q * (r * r * r) * fma_lanes", "0.9f * q * (r * r * r) * fma_lanes"),
        Mutant("fma_lanes(g.degree4, k, g.degree3)", "fma_lanes(0.5f * g.degree4, k, g.degree3)"),
        Mutant("fma_lanes(g.degree4, k, g.degree3)", "fma_lanes(g.degree4, k, 0.5f * g.degree3)"),
        Mutant("fma_lanes(g.rest, series_tail(k), fma_lanes(g", "fma_lanes(0.0f * g.rest, series_tail(k), fma_lanes(g"),
        Mutant("term[kFieldBound] += error", "term[kFieldBound] += 0.5f * error"),
        Mutant("term[kFieldWeight] += weight", "term[kFieldWeight] += 0.0f * weight"),
    ],
    "exact/light_rays.cl": [
        Mutant("(i < count ? i : count - 1)", "i", same="a ray that isn't there is aimed, and not traced"),
        Mutant("if (HOLES && open)", "if (false)"),
        Mutant("if (first % 32 == 0 && first + kTreeWidth < end) continue", "if (first % 32 == 0) continue"),
    ],
    "exact/light_samples.h": [
        Mutant("(bits & 0x0f0f) << 4", "(bits & 0x0f0f) << 3"),
        Mutant("index ^= index >> 4 & 0x0f0f;", ""),
        Mutant("turn == 1 || turn == 2 ? -x : x", "turn == 1 ? -x : x"),
        Mutant("turn % 2 == 0 ? across : along", "across"),
        Mutant("hash = hashed(hash ^ float_bits(start.z));", ""),
        Mutant("cone->distance <= cone->size) return false", "false) return false"),
        Mutant("double_bits(z) >> 63 != 0 ? -1.0 : 1.0", "1.0"),
        Mutant("1 + sqrt(1 - sine * sine)", "2.0"),
        Mutant("square > 0 ? square : 0.0", "square", same="the samples nearest to the rim are within it by 2^-16 of the solid angle, more than roundings"),
        Mutant("along = -cosine_to;", "along = cosine_to;"),
    ],
    "exact/open_pairs.cl": [
        Mutant("shares[share] != OPEN_SHARE) continue", "false) continue"),
        Mutant("open[at].light = light;", "open[at].light = 0;"),
        Mutant("word * 32 + bit;", "word * 32;"),
        Mutant("shares[share] = seen[at];", "shares[share] = 1.0f;"),
        Mutant("seen[at] > 0.0f", "true"),
        Mutant("left; left &= left - 1, ++share) {", "left; left &= left - 1) {"),
    ],
    "exact/pair_rays.cl": [
        Mutant("if (light->size == 0.0f) return OPEN_SHARE;", "", same="in floats all samples of such a light are at its place"),
        Mutant("return 1.0f;", "return 0.0f;"),
        Mutant("light->number, samples)", "0, samples)"),
        Mutant("LIFT ? load_lanes(buffers->lift + at) : (floatL)(0.0f)", "(floatL)(0.0f)"),
        Mutant("light_sample(first + from + i,", "light_sample(first + i,"),
        Mutant("rays->open[row] & rays->unblocked[row]", "rays->open[row]", same="a blocked sample is open only until a triangle blocks it, and then the host says the same"),
        Mutant("rays->open[row] & rays->unblocked[row]) return OPEN_SHARE", "false) return OPEN_SHARE"),
        Mutant("open += seen == OPEN_SHARE", "open += 1", same="the host's list is longer than what is written and read"),
        Mutant("buffers->first_share[at] = share;", "buffers->first_share[at] = 0;"),
    ],
    "exact/ray_walk.clh": [
        Mutant("last->width[to] = width", "last->width[to] = 0.0f"),
        Mutant("side_of_light(blocks, reference, light) == (height > 0.0f ? 1 : -1)", "side_of_light(blocks, reference, light) != 0"),
        Mutant("edges_hold(blocks, reference, light, start) &&", "true &&"),
        Mutant("is_before(blocks, reference, light, start)", "true"),
        Mutant("!blocks_exactly(scene->blocks, reference, light, start)", "false"),
        Mutant("if (opacity == kSolid) return lane", "return lane"),
        Mutant("*unsure |= opacity == kMixed", "*unsure |= false"),
        Mutant("if (found.sure & within) return true", "if (found.may & within) return true"),
        Mutant("if (!(holes >> lane & 1)) remember_triangle", "remember_triangle"),
        Mutant("sure = found.sure & within & ~holes", "sure = found.sure & within"),
        Mutant("walk->width = greater(", "walk->width = lesser("),
        Mutant("walk->left ^= 1u << child", "walk->left = 0"),
        Mutant("if (walk.left) {", "if (false) {"),
    ],
    "exact/ray_starts.cl": [
        Mutant("starts + stride + at, start.y", "starts + stride + at, start.x"),
        Mutant("LIFT ? load_lanes(lift + at) : (floatL)(0.0f)", "(floatL)(0.0f)"),
    ],
    "exact/rays.clh": [
        Mutant("VALUE_ROUNDING (96.0f * 0x1p-24f)", "VALUE_ROUNDING 0.0f"),
        Mutant("VALUE_ROUNDING2 (1024.0f * 0x1p-48f)", "VALUE_ROUNDING2 0.0f"),
        Mutant("far = max_lanes(far, from + of_tree)", "far = 0.0f"),
        Mutant("0x1p-22f * abs_lanes(from) + 0x1p-36f * all", "-0x1p-22f * abs_lanes(from) + 0x1p-36f * all"),
        Mutant("abs_lanes(from) + 0x1p-36f * all * abs_lanes(inverse[axis])", "abs_lanes(from)"),
        Mutant("enter <= leave * (1.0f + 0x1p-20f)", "enter < leave"),
        Mutant("leave = g->end[i]", "leave = FAR_END", same="boxes beyond a light are visited for nothing"),
        Mutant("leave = g->end[i]", "leave = 1.0f"),
        Mutant("TURNED(start, ahead, k + 1)", "TURNED(start, ahead, k)"),
        Mutant("inverse_ahead * TURNED(way, ahead, k + 1)", "inverse_ahead * TURNED(way, ahead, k + 2)"),
        Mutant("abs_lanes(way[axis]) > longest ?", "abs_lanes(way[axis]) < longest ?"),
        Mutant("longest >= least ? VALUE_ROUNDING2", "longest >= 0.0f ? VALUE_ROUNDING2"),
        Mutant("max_lanes((floatL)(g->tolerance[i]), planes->rounding)", "planes->rounding"),
        Mutant("max_lanes((floatL)(g->tolerance[i]), planes->rounding)", "(floatL)(g->tolerance[i])"),
        Mutant("< 0 ? edges->least : -edges->most", ">= 0 ? edges->least : -edges->most"),
        Mutant("offset = parallel ? (floatL)(0.0f) : planes->offset", "offset = planes->offset"),
        Mutant("beyond & near & (inside", "beyond & (inside"),
        Mutant("(inside >= -rounding) & (light <= clear)", "(inside >= rounding) & (light <= clear)"),
        Mutant("(inside > 3.0f * rounding) & (light < -clear)", "(inside >= -rounding) & (light < -clear)"),
        Mutant("(inside > 3.0f * rounding) & (light < -clear)", "(inside > 3.0f * rounding) & (light < clear)"),
        Mutant("(inside >= -rounding) & (light <= clear)", "(inside >= -rounding) & (light <= -clear)"),
        Mutant("opacity_at(masks, block, slot, holes, edges, rounding) : kMixed", "kMixed : kMixed"),
    ],
    "exact/sample_rays.clh": [
        Mutant("SAMPLE_ROUNDING (16.0f * 0x1p-24f)", "SAMPLE_ROUNDING 0.0f"),
        Mutant("SAMPLE_ROUNDING (16.0f * 0x1p-24f)", "SAMPLE_ROUNDING 1.0f", same="more is decided by exact_sign.h"),
        Mutant("(upper ? low[axis] : high[axis])", "(upper ? high[axis] : low[axis])"),
        Mutant("bound > 0.0f ? -from - margin : margin - from", "-from"),
        Mutant("enter <= leave * (1.0f + 0x1p-20f)", "enter < leave", same="bounds are moved outwards, too, by more than most roundings"),
        Mutant("rays->end = rays->parallel ? FAR_END : 1.0f", "rays->end = FAR_END", same="boxes beyond a light are visited for nothing"),
        Mutant("rays->end = rays->parallel ? FAR_END : 1.0f", "rays->end = 1.0f"),
        Mutant("rays->tolerance = POINT_ERROR * sum", "rays->tolerance = 0.0f"),
        Mutant("meets &= light - beside <= 2.0f * clear", "meets &= light + beside <= 2.0f * clear"),
        Mutant("meets &= light - beside <= 2.0f * clear;", "", same="no sample's light is before such a triangle's plane; it costs tests"),
        Mutant("max_lanes((floatL)(rays->tolerance), own)", "(floatL)(rays->tolerance)"),
        Mutant("max_lanes((floatL)(rays->tolerance), own)", "own"),
        Mutant("offset = rays->parallel ? (floatL)(0.0f) : turned_by(offset, turn)", "offset = turned_by(offset, turn)"),
        Mutant("uint j = k == 2 ? 0 : k + 1;", "uint j = k == 2 ? 1 : k + 1;"),
        Mutant("intL flip = turn ^ (int)0x80000000;", "intL flip = turn;"),
        Mutant("meets &= least >= -2.0f * rounding", "meets &= least >= 2.0f * rounding"),
        Mutant("rays->parallel ? 0.0f : 1.0f);", "1.0f);"),
        Mutant("blocks_exactly(scene->blocks, reference, light, rays->start)", "false"),
        Mutant("blocks_exactly(scene->blocks, reference, light, rays->start)", "true"),
        Mutant("blocks = opacity == kSolid;", "blocks = opacity != kHole;"),
        Mutant("if (opacity == kMixed) rays->open[row] |= 1u << bit;", ""),
        Mutant("if ((HOLES && holes) || may & ~sure)", "if (may & ~sure)"),
        Mutant("(least >= -t->rounding[lane]) & (light <= t->clear[lane])", "(least >= t->rounding[lane]) & (light <= t->clear[lane])"),
        Mutant("(least >= -t->rounding[lane]) & (light <= t->clear[lane])", "(least >= -t->rounding[lane]) & (light <= -t->clear[lane])"),
        Mutant("(least > t->rounding[lane]) & (light < -t->clear[lane])", "(least > -t->rounding[lane]) & (light < -t->clear[lane])"),
        Mutant("(least > t->rounding[lane]) & (light < -t->clear[lane])", "(least > t->rounding[lane]) & (light < t->clear[lane])"),
        Mutant("rays->left -= popcount(may);", ""),
        Mutant("bits >> (kTreeWidth + at + lane) & 1", "false"),
        Mutant("if (block != first && test_block", "if (test_block", same="a block tested twice says the same"),
    ],
    "exact/hole_masks.clh": [
        Mutant("float b = quotient(edges[2], sum), c", "float b = quotient(edges[1], sum), c"),
        Mutant("popcount(holes & ((1u << slot) - 1))", "popcount(holes & ((2u << slot) - 1))"),
        Mutant("if (wrap == kWrapClamped) return (uint)(texel < 0 ? 0 : last);", "if (wrap == kWrapClamped) return (uint)(texel < 0 ? last : 0);"),
        Mutant("texel > last ? period - 1 - texel : texel", "texel > last ? texel - (int)size : texel"),
        Mutant("wrap == kWrapMirrored ? 2 * (int)size : (int)size", "(int)size"),
        Mutant("float low = place - error - 0.5f, high = place + error - 0.5f;", "float low = place - error, high = place + error;"),
        Mutant("return low >= t->solid_from ? kSolid : high <= t->hole_to ? kHole : kMixed;",
               "return high >= t->solid_from ? kSolid : low <= t->hole_to ? kHole : kMixed;"),
        Mutant("if (texel < 0) texel += period;", "if (texel < 0) texel = 0;"),
    ],
    "clusters/lobes.clh": [
        Mutant("swing = view->k + group->turn;", "swing = view->k;"),
        Mutant("swing = view->k + group->turn;", "swing = group->turn;"),
        Mutant("fma_lanes(chord + group->turn, inverse, (floatL)(group->place.spread))", "(chord + group->turn) * inverse"),
        Mutant("fma_lanes(chord + group->turn, inverse", "fma_lanes(chord, inverse"),
        Mutant("fma_lanes(chord + group->turn, inverse", "fma_lanes((floatL)(group->turn), inverse"),
        Mutant("1.1f * view->k : (floatL)(2.0f)", "0.8f * view->k : (floatL)(2.0f)"),
        Mutant("1.1f * view->k : (floatL)(2.0f)", "1.1f * view->k : (floatL)(0.5f)"),
        Mutant("fma_lanes(sine, swing, (floatL)(LOBE_SLACK))", "0.9f * sine * swing"),
        Mutant("around ? (floatL)(1.0f)", "around ? lobe.center"),
        Mutant("lobe.sine = min_lanes(sine + swing", "lobe.sine = min_lanes(0.5f * sine + swing"),
        Mutant("lobe.sine = min_lanes(sine + swing", "lobe.sine = min_lanes(sine"),
        Mutant("room = (floatL)(1.0f) - view->k, scale", "room = (floatL)(1.0f), scale"),
        Mutant("return power * scale * scale;", "return 0.9f * power * scale * scale;"),
    ],
    "clusters/lobe_series.clh": [
        Mutant("fma_lanes(group->turn * view->distance, (floatL)(1.0f) + view->k, (floatL)(group->place.radius))", "group->place.radius"),
        Mutant("fma_lanes(group->turn * view->distance, (floatL)(1.0f) + view->k, (floatL)(group->place.radius))", "group->turn * view->distance"),
        Mutant("fma_lanes(at, extent.q, 3.0f * extent.a1)", "fma_lanes(at, 0.0f * extent.q, 3.0f * extent.a1)"),
        Mutant("fma_lanes(at, extent.q, 3.0f * extent.a1)", "at * extent.q"),
        Mutant("3.0f * extent.a2), extent.a3)", "0.0f), extent.a3)"),
        Mutant("3.0f * extent.a2), extent.a3)", "3.0f * extent.a2), 0.0f * extent.a3)"),
        Mutant("(p - 1.0f) * (p - 2.0f) * s2, 3.0f", "(p - 1.0f) * (p - 2.0f) * (0.5f * s2), 3.0f"),
        Mutant("p * (p - 1.0f) * (p - 2.0f) * s2, 3.0f", "0.0f * s2, 3.0f"),
        Mutant("3.0f * p * (p + 2.0f) * c2", "1.5f * p * (p + 2.0f) * c2"),
        Mutant("3.0f * p * (p + 2.0f) * c2", "0.0f * c2"),
        Mutant("c * max_lanes(p * (p - 1.0f) * s2", "c * max_lanes(0.5f * p * (p - 1.0f) * s2"),
        Mutant("c * max_lanes(p * (p - 1.0f) * s2", "c * max_lanes(0.0f * s2"),
        Mutant("s2, (p + 2.0f) * c2)", "s2, 0.5f * (p + 2.0f) * c2)"),
        Mutant("s2, (p + 2.0f) * c2)", "s2, 0.0f * c2)"),
        Mutant("y = 6.93f * c", "y = 3.46f * c"),
        Mutant("fma_lanes(x, x, y * y)", "x * x"),
        Mutant("fma_lanes(x, x, y * y)", "y * y"),
        Mutant("quotient_lanes(view->inverse_d, (floatL)(1.0f) - view->k)", "view->inverse_d"),
        Mutant("0.16667f * third", "0.083f * third"),
        Mutant("lobe_power(group, lobe) * near2", "near2"),
        Mutant("by_n = powers.b0 * inverse_d", "by_n = -powers.b0 * inverse_d"),
        Mutant("term[kLobeW + 1] = n.y * powers.a1", "term[kLobeW + 1] = n.x * powers.a1"),
        Mutant("term[kLobeHH + 2] = d2 *", "term[kLobeHH + 2] = half_d2 *"),
        Mutant("term[kLobeHW + 5] = z.y * n.z", "term[kLobeHW + 5] = z.z * n.y"),
        Mutant("term[kLobeWW + 3] = half_a2", "term[kLobeWW + 3] = powers.a2"),
        Mutant("0.5f * bend * d2", "bend * d2"),
        Mutant("fma_lanes(powers.b00, nm, -powers.b1 * rm)", "fma_lanes(powers.b00, nm, powers.b1 * rm)"),
        Mutant("fma_lanes(n.z, along, m.z * a1d)", "fma_lanes(n.z, along, -m.z * a1d)"),
        Mutant("term[kLobeBound] += mask ? error : none", "term[kLobeBound] += mask ? 0.5f * error : none"),
        Mutant("32.0f * exponent + (float)(128 + kFieldBlock + sums->closed)", "0.0f"),
    ],
    "clusters/highlights.clh": [
        Mutant("half_of_it = mask ? 0.5f * brightest", "half_of_it = mask ? brightest",
               same="value and bound are both as large as the light can be: right, and looser"),
        Mutant("kClusterAbsolute), half_of_it, term[kLobeBound])", "kClusterAbsolute), 0.5f * half_of_it, term[kLobeBound])"),
        Mutant("verdict.below = lane_bits(view->height < -view->margin)", "verdict.below = lane_bits(view->height < view->margin)"),
        Mutant("(view->height > view->margin) &", "(view->height > -view->margin) &"),
        Mutant("group->exponent >= 3.0f", "group->exponent >= 0.0f"),
    ],
    "clusters/listed_highlights.clh": [
        Mutant("block_unsure = fma_lanes((floatL)(light.color.w)", "block_unsure = fma_lanes((floatL)(0.0f)"),
        Mutant("HORIZON_SLACK 0x1p-19f", "HORIZON_SLACK 0x1p-26f"),
        Mutant("40.0f * root + 0x1p-24f", "20.0f * root + 0x1p-24f"),
        Mutant("(38.0f + quotient(135.0f, exponent))", "quotient(135.0f, exponent)"),
        Mutant("(38.0f + quotient(135.0f, exponent))", "38.0f"),
        Mutant("(13.1f + 450.0f * root)", "(6.5f + 450.0f * root)"),
        Mutant("(13.1f + 450.0f * root)", "13.1f"),
        Mutant("(36.0f + quotient(141.0f, exponent))", "quotient(141.0f, exponent)"),
        Mutant("(36.0f + quotient(141.0f, exponent))", "36.0f"),
        Mutant("-10.0f : -17.0f", "-20.0f : -17.0f"),
        Mutant("-10.0f : -17.0f", "-10.0f : -34.0f"),
        Mutant("(floatL)(2.0f * COSINE2_ROUNDING),", "(floatL)(0.0f * COSINE2_ROUNDING),"),
        Mutant("least_root = exponent >= 4.0f ? 0.0f : 1.0f", "least_root = 0.0f"),
        Mutant("max_lanes(root + error, least_root)", "max_lanes(root, least_root)"),
        Mutant("max_lanes(root + error, least_root)", "max_lanes(error, least_root)"),
        Mutant("rsqrt_lanes(max_lanes(sum2,", "0.5f * rsqrt_lanes(max_lanes(sum2,"),
        Mutant("n_dot_l > -HORIZON_SLACK ? error", "n_dot_l > 0.0f ? error"),
        Mutant("sums->rounding += block_rounding", "sums->rounding = block_rounding"),
        Mutant("sums->unsure += block_unsure", "sums->unsure = block_unsure"),
    ],
    "clusters/light_clusters.clh": [
        Mutant("k = (radius + group->radius) *", "k = radius *"),
        Mutant("k = (radius + group->radius) *", "k = group->radius *"),
        Mutant("abs_lanes(height_share) + group->spread", "abs_lanes(height_share)"),
        Mutant("abs_lanes(height_share) + group->spread", "0.5f * abs_lanes(height_share) + group->spread"),
        Mutant("view.width + group->thickness +", "0.5f * view.width + group->thickness +"),
        Mutant("view.width + group->thickness +", "view.width + 0.5f * group->thickness +"),
        Mutant("view.distance + extent.x + extent.y", "extent.x + extent.y"),
        Mutant("distance + extent.x + extent.y + extent.z", "distance + extent.y + extent.z"),
        Mutant("distance + extent.x + extent.y + extent.z", "distance + extent.x + extent.z"),
        Mutant("distance + extent.x + extent.y + extent.z", "distance + extent.x + extent.y"),
        Mutant("fma_lanes((floatL)(group->spread)", "fma_lanes((floatL)(0.5f * group->spread)"),
        Mutant("0x1p-18f * (view.distance + radius)", "0x1p-40f * (view.distance + radius)"),
        Mutant("above = far & (view->height > view->margin)", "above = far & (view->height > -view->margin)"),
        Mutant("{lane_bits(view->height < -view->margin)", "{lane_bits(view->height < view->margin)"),
        Mutant("greater(group->normal[2], -group->normal[2])", "group->normal[2]"),
        Mutant("part, group->radius, inverse_d, min", "part, 0.5f * group->radius, inverse_d, min"),
        Mutant("MOST_FAR 0.7f", "MOST_FAR 1.5f"),
        Mutant("(floatL)(0.5f) : none", "(floatL)(1.0f) : none"),
        Mutant("(abs_lanes(view->height) <= view->margin))}", "(abs_lanes(view->height) <= 0.1f * view->margin))}"),
        Mutant("walk->lights + 8 * kLeafLights >", "walk->lights >"),
        Mutant("first_below + node + lowest_bit(bits)", "first_below + node + lowest_bit(bits) - 1"),
        Mutant("row.levels = row.level == 0 ? top : 3", "row.levels = 3"),
        Mutant("cut = verdict.cut & seen & ~verdict.above", "cut = verdict.cut & seen",
               same="what is above has a height of more than the margin, what is cut hasn't"),
        Mutant("light->place.z - position.z + light->rest.z", "light->place.z - position.z"),
        Mutant("group->middle[1] + row_field(row, part, kLightRest + 1)", "group->middle[1]"),
        Mutant("view.k = group->radius *", "view.k = 0.5f * group->radius *"),
        Mutant("(floatL)(group->spread + 0x1p-18f)", "(floatL)(0x1p-18f)"),
        Mutant("view.distance, (floatL)(group->thickness))", "view.distance, (floatL)(0.0f))"),
        Mutant("light_series_error(q, group->radius", "light_series_error(q, 0.5f * group->radius"),
        Mutant("dark |= lane_bits((view[part].height < -view[part].margin)", "dark |= lane_bits((view[part].height < view[part].margin)"),
        Mutant("(view[part].height > view[part].margin) &", "(view[part].height > -view[part].margin) &"),
        Mutant("(group->gain * error[part] < LIGHT_SHARE * share)", "(error[part] >= 0.0f)"),
        Mutant("far &= slots;", ""),
        Mutant("slots & ~far, walk)", "slots, walk)"),
    ],
    "random.clh": [
        Mutant("1664525u + 1013904223u", "1664525u + 1013904222u"),
        Mutant("v ^= v >> 16u", "v ^= v >> 15u"),
        Mutant("seed.w ^= b;", "seed.w ^= a;"),
        Mutant("(float)(bits >> 8)", "(float)(bits >> 9)"),
    ],
    "sampled/strata.clh": [
        Mutant("quotient(0.5f * sum, greater(", "quotient(sum, greater("),
        Mutant("node.share * quotient(weight[i], sum)", "quotient(weight[i], sum)"),
        Mutant("node.share * quotient(weight[i], sum)", "node.share"),
        Mutant("greater(node.share * of_lights[i], 1e-37f)", "greater(of_lights[i], 1e-37f)"),
        Mutant("greater(node.share * of_lights[i], 1e-37f)", "greater(node.share * sum, 1e-37f)"),
        Mutant("((float)pick + xi) * step < reached", "((float)pick + xi) * 0.5f * step < reached"),
        Mutant("((float)pick + xi) * step < reached", "((float)pick + 0.5f) * step < reached"),
        Mutant("last = weight[i] > 0.0f ? i : last", "last = i"),
        Mutant("if (i == last && sum > 0.0f)", "if (false)"),
        Mutant("sum > 0.0f ? count : 0", "count"),
        Mutant("return above > 0.0f ? light", "return view->height > 0.0f ? light"),
        Mutant("view->margin, view->height), 0.15f * above)", "view->margin, view->height), above - above)"),
        Mutant("(0xffffffffu >> (2 * kPicks - count)) << first", "(0xffffffffu >> (2 * kPicks - count))"),
        Mutant("if (!(used >> k & 1)) continue;", ""),
        Mutant("fma_lanes((floatL)(bounds->shine.place.radius), view->inverse_d, (floatL)(0x1p-18f))", "(floatL)(0x1p-18f)"),
        Mutant("(at.node + 1)) >> at.level", "(at.node + 1) - 1) >> at.level"),
        Mutant("picks->light[k] = leaf * kLeafLights + in_leaf + i", "picks->light[k] = leaf * kLeafLights + i"),
        Mutant("of_lights = weight + LEAF_SLOT(leaf) + in_leaf", "of_lights = weight + LEAF_SLOT(leaf)"),
        Mutant("uint slot = LEAF_SLOT(leaf) - first_light_of(tree, of_leaf)", "uint slot = 0u - first_light_of(tree, of_leaf)"),
        Mutant("most[side] += of_slot[slot + i]", "most[side] = of_slot[slot + i]"),
    ],
    "sampled/cut.clh": [
        Mutant("cut->cost -= 2", "cut->cost -= 1"),
        Mutant("cut->cost += stratum->lights == 1 ? 1 : 2", "cut->cost += 2"),
        Mutant("if (stratum->lights > 2) push_heap", "if (stratum->lights > 3) push_heap"),
        Mutant("if (!(most[side] > 0.0f)) continue;", "if (!(most[side] > 1e-3f)) continue;"),
        Mutant("cut->strata[cut->heap[(at - 1) / 2]].key < key", "cut->strata[cut->heap[(at - 1) / 2]].key > key"),
        Mutant("if (!(cut->strata[cut->heap[child]].key > key)) break", "if (cut->strata[cut->heap[child]].key > key) break"),
        Mutant("2 * whole.node + side}", "2 * whole.node}"),
        Mutant("if (taken) place = cut->strata_count++", "place = cut->strata_count++"),
        Mutant("if (whole.values != kNoValues) cut->free_values", "if (false) cut->free_values"),
        Mutant("|| cut->strata_count == kMostStrata) return false", ") return false"),
        Mutant("cut->strata[cut->order[child]].first > first)) break", "cut->strata[cut->order[child]].first < first)) break"),
    ],
    "sampled/sampled_group.clh": [
        Mutant("LIFT ? fma(up, n, p) : p", "p"),
        Mutant("MODEL_IS(kBlinnPhongModel) ? eye : mirror(eye, normal)", "mirror(eye, normal)"),
        Mutant("MODEL_IS(kBlinnPhongModel) ? eye : mirror(eye, normal)", "eye"),
        Mutant("if (SAMPLED_HIGHLIGHTS) is_alike &= tile->specular[at + 3 * tile->stride] == group->exponent", ""),
        Mutant("group->field[kSurfaceNormal + axis][to] = facing[axis]", "group->field[kSurfaceNormal + axis][to] = -facing[axis]"),
        Mutant("return ((x0 ^ y0) | y0 << 1) << 2", "return (x0 ^ y0) << 2"),
        Mutant("values[i] += values[i + step]", "values[i] += values[i]"),
        Mutant("*(floatL*)(values + i) += *(const floatL*)(values + i + step)", "*(floatL*)(values + i) += *(const floatL*)(values + i)"),
    ],
    "sampled/sampled_light.cl": [
        Mutant("float left = hidden ? 0.0f : 0.5f", "float left = 0.0f"),
        Mutant("float left = hidden ? 0.0f : 0.5f", "float left = hidden ? 0.5f : 0.5f"),
        Mutant("1ul << at % kSampledPixels", "0ul << at % kSampledPixels"),
        Mutant("cut->unsure[2 * stratum.values + 1], sums)", "0ul, sums)"),
        Mutant("falloff = n_dot_l > none ? falloff : none", "falloff = falloff"),
        Mutant("> -0x1p-13f ? falloff : none", "> -2.0f ? falloff : none"),
        Mutant("color.y * light->diffuse.y * strength", "color.y * light->diffuse.x * strength"),
        Mutant("fma_lanes(color.y * light->specular.y, strength", "fma_lanes(color.y * light->diffuse.y, strength"),
        Mutant("0.5f * exponent", "exponent"),
        Mutant("phong_lobe(u, inverse_d, axis), exponent", "phong_lobe(u, inverse_d, axis), 0.5f * exponent"),
        Mutant("power *= kept_energy(exponent, narrow, 1.0f)", "power *= 1.0f"),
        Mutant("power *= kept_energy(exponent, narrow, 2.0f)", "power *= 1.0f"),
        Mutant("light->round - dot3(light->axis, u)", "light->round + dot3(light->axis, u)"),
        Mutant("if (parallel) position.x = position.y = position.z = 0.0f;", ""),
        Mutant("if (place.w == kNoRay) continue;", ""),
        Mutant("share += min_lanes(first * first", "share += 0.0f * min_lanes(first * first"),
        Mutant("square = fma_lanes(first, first, half_width * half_width)", "square = half_width * half_width"),
        Mutant("light->place.z - position.z + light->rest.z", "light->place.z - position.z"),
        Mutant("to[5][lane] = from->rest.z", "to[5][lane] = from->rest.x"),
        Mutant("light[k].color *= weight", ""),
        Mutant("group->pick[i + lane] ^ turn : 0", "group->pick[i + lane] : 0"),
        Mutant("light < stratum->lights ? slot + light : kNoPick", "slot + light"),
        Mutant("picks->weight[k] = 1.0f", "picks->weight[k] = 0.5f"),
        Mutant("*(floatL*)(sums->light[c] + j) += a + b", "*(floatL*)(sums->light[c] + j) += a"),
        Mutant("store_lanes(cut->values + first_value + c * kSampledPixels + i, value)", "store_lanes(cut->values + first_value + c * kSampledPixels + i, 0.5f * value)"),
        Mutant("fma_lanes(apart, apart, *(const floatL*)(sums->variance[c] + j))", "fma_lanes(0.5f * apart, apart, *(const floatL*)(sums->variance[c] + j))"),
        Mutant("fma_lanes(apart, apart, *(const floatL*)(sums->variance[c] + j))", "apart * apart"),
        Mutant("HALVES_DIFFER 0.8f", "HALVES_DIFFER 0.4f"),
        Mutant("GROUP_PAIRS * of_group + own", "0.5f * GROUP_PAIRS * of_group + own"),
        Mutant("GROUP_PAIRS * of_group + own", "own"),
        Mutant("own * HALVES_DIFFER * variance", "0.0f * variance"),
        Mutant("UNSEEN_PAIRS 1.0f", "UNSEEN_PAIRS 0.0f"),
        Mutant("fma(stratum.unshadowed, stratum.unshadowed, squares)", "squares"),
        Mutant("renew_kept(cut);", ""),
        Mutant("seed.x += RENEWED_SEED;", ""),
        Mutant("(floatL)(GROUP_PAIRS + own)", "(floatL)(2.0f * GROUP_PAIRS + own)"),
        Mutant("quotient_lanes(frame->deviations * seen, room)", "quotient_lanes(0.5f * frame->deviations * seen, room)"),
        Mutant("share = share * share * variance", "share = 0.25f * share * share * variance"),
        Mutant("if (worst <= 1.0f || is_last) break", "if (worst <= 4.0f || is_last) break"),
        Mutant("if (!(worst <= 1.0f)) counts->of[kMissedPixels]", "if (false) counts->of[kMissedPixels]"),
        Mutant("max_lanes(light, (floatL)(frame->least_value))", "max_lanes(light, (floatL)(1.0f))"),
        Mutant("max_lanes(light, (floatL)(frame->least_value))", "(floatL)(frame->least_value)",
               same="bright pixels are more precise than asked for, and take more rays"),
        Mutant("max_lanes(allowed - proven, 0.5f * allowed)", "allowed"),
        Mutant("rounding = 0x1p-24f * (float)(LIGHT_ROUNDING", "rounding = 0.0f * (float)(LIGHT_ROUNDING"),
        Mutant("half_width = frame->deviations * seen * deviation", "half_width = 0.5f * frame->deviations * seen * deviation"),
        Mutant("half_width = frame->deviations * seen * deviation", "half_width = frame->deviations * deviation"),
        Mutant("finite_color(*(const floatL*)(before->light[c] + j) + *(const floatL*)(sums->light[c] + j))", "finite_color(*(const floatL*)(sums->light[c] + j))"),
        Mutant("planes->bound[at] = proven[j]", "planes->bound[at] = 0.0f"),
        Mutant("planes->half_width[at] = width[j]", "planes->half_width[at] = 0.0f"),
        Mutant("seed = (uint4)(frame->seed, pixel.x", "seed = (uint4)(0u, pixel.x"),
        Mutant("seed = (uint4)(frame->seed, pixel.x, pixel.y,", "seed = (uint4)(frame->seed, 0u, 0u,"),
        Mutant("if (reflects && tile->position", "if (tile->position", same="black pixels take no light, and some time"),
    ],
    "exact/wide_integer.h": [
        Mutant("exponent != 0 ? exponent : 1", "exponent"),
        Mutant("? 0x800000 : 0", "? 0x800000 : 0x800000"),
        Mutant("digits <<= shift % 32", "digits <<= shift % 31"),
        Mutant("carry = flip & 1", "carry = 0"),
        Mutant("carry += (ulong)sum[i] +", "carry += sum[i] +"),
        Mutant("digits >>= 32", "digits = 0"),
        Mutant("sum[i + j] + (ulong)a[i] * b[j]", "(ulong)a[i] * b[j]"),
        Mutant("sum[i + j] + (ulong)a[i] * b[j]", "sum[i + j] + a[i] * b[j]"),
        Mutant("if (integer[words - 1] >> 31 != 0) return -1;", ""),
        Mutant("any |= integer[i]", "any = integer[i]"),
    ],
}


@dataclasses.dataclass
class Found:
    """A mutant's place: a line of a kernel file, counted from 1, as it is and as it becomes."""
    file: str
    number: int
    old_line: str
    new_line: str
    mutant: Mutant


def fail(message):
    print(f"mutate_kernels.py: {message}", file=sys.stderr)
    sys.exit(2)


def find_places(files):
    """Of each mutant of the files its place. Ends the program where an `old` isn't there, or more than once."""
    places, wrong = [], []
    for file in files:
        lines = (ROOT / "kernels" / file).read_text().split("\n")
        for mutant in MUTANTS[file]:
            hits = [(i, line) for i, line in enumerate(lines) for _ in range(line.count(mutant.old))]
            if len(hits) == 1:
                i, line = hits[0]
                places.append(Found(file, i + 1, line, line.replace(mutant.old, mutant.new), mutant))
            else:
                wrong.append(f"  kernels/{file}: {len(hits)} times: {mutant.old}")
    if wrong:
        fail("the table must name text that stands once in its file, and doesn't:\n" + "\n".join(wrong))
    return places


class Runner:
    """Runs tests of a build, with or without a mutant."""

    def __init__(self, build, temporary):
        self.build, self.temporary = build, temporary
        self.library = build / "mutate_kernels.so"
        subprocess.run(["cc", "-O1", "-Wall", "-Wextra", "-shared", "-fPIC", "-o", self.library,
                        ROOT / "tests" / "mutate_kernels.c", "-ldl"], check=True)
        self.limits = {}  # seconds, by test, of those that were run without a mutant
        self.lock = threading.Lock()

    def run(self, test, environment, limit):
        """None if the tests pass, else the first that fails."""
        program, tests = test
        command = [self.build / "tests" / f"{program}_test", f"--gtest_filter={tests}", "--gtest_fail_fast", "--gtest_brief=1"]
        # A cache of its own: what the mutants leave there doesn't stay in the tests'.
        environment = dict(os.environ, POCL_CACHE_DIR=str(self.build / "mutants_cache"), **environment)
        process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                                   cwd=self.build / "tests", start_new_session=True)
        try:
            output, _ = process.communicate(timeout=limit)
        except BaseException as error:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            if isinstance(error, subprocess.TimeoutExpired):
                return f"{program}_test {tests}, which doesn't end"
            raise
        if process.returncode == 0:
            if " 0 tests from " in output:
                fail(f"{program}_test has no test {tests}")
            return None
        failed = re.search(r"^\[  FAILED  \] ([^, \n]+)", output, re.MULTILINE)
        return failed[1] if failed else f"{program}_test {tests}, which ends with status {process.returncode}"

    def limit(self, test):
        """Seconds after which a test is taken not to end. The first time, the test must pass without a mutant."""
        with self.lock:
            if test not in self.limits:
                start = time.monotonic()
                failed = self.run(test, {}, None)
                if failed:
                    fail(f"{failed} fails without any mutant")
                seconds = time.monotonic() - start
                # Where it compiled no kernel, a mutant makes it.
                self.limits[test] = 120 + 10 * seconds
                print(f"        {seconds:.1f} s without a mutant: {test[0]}_test --gtest_filter='{test[1]}'", flush=True)
            return self.limits[test]

    def verdict(self, place):
        log = pathlib.Path(tempfile.mkstemp(dir=self.temporary)[1])
        environment = {"LD_PRELOAD": str(self.library), "MUTANT_FILE": f"kernels/{place.file}", "MUTANT_LINE": str(place.number),
                       "MUTANT_OLD": place.old_line, "MUTANT_NEW": place.new_line, "MUTANT_LOG": str(log)}
        killer = None
        for test in TESTS[place.file]:
            killer = self.run(test, environment, self.limit(test))
            if killer:
                break
        events = set(log.read_text().split())
        if "stale" in events:
            return "stale", ""
        if "built" not in events:
            return ("broken" if "broken" in events else "unseen"), ""
        if killer:
            return "killed", f"by {killer}"
        return ("same" if place.mutant.same else "LIVED"), place.mutant.same


def main():
    parser = argparse.ArgumentParser(description="Which mistakes in the kernels do the tests find?")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--check", action="store_true", help="only whether the table fits the kernels")
    parser.add_argument("files", nargs="*", metavar="FILE", choices=[[], *MUTANTS], help="kernel files; default: all")
    parser.add_argument("--sample", type=int, metavar="N", help="only N mutants, spread evenly over the files")
    options = parser.parse_args()
    files = options.files or list(MUTANTS)
    places = find_places(files)
    if options.check:
        return
    if options.sample and options.sample < len(places):
        places = [places[i * len(places) // options.sample] for i in range(options.sample)]
    counts = {}
    with tempfile.TemporaryDirectory() as temporary:
        runner = Runner(options.build.resolve(), pathlib.Path(temporary))
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            for place, (verdict, why) in zip(places, pool.map(runner.verdict, places)):
                if verdict == "stale":
                    pool.shutdown(cancel_futures=True)
                    fail(f"{options.build} was built from another kernels/{place.file}")
                counts[verdict] = counts.get(verdict, 0) + 1
                wrongly_same = place.mutant.same and verdict == "killed"
                if wrongly_same:
                    counts["killed, but called the same"] = counts.get("killed, but called the same", 0) + 1
                print(f"{verdict:7s} kernels/{place.file}:{place.number}: {place.mutant.old}  →  {place.mutant.new}  {why}", flush=True)
    print(f"{len(places)} mutants: " + ", ".join(f"{count} {verdict}" for verdict, count in sorted(counts.items())))
    return 0 if set(counts) <= {"killed", "same"} else 1


if __name__ == "__main__":
    sys.exit(main())

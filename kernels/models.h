// The table of shading models, shared by host and kernels: X(name in code, as people type it, as --stats
// shows it, what it does, the most that it makes of a light of 1, as factors of the diffuse colour and as a
// channel of the highlight). The last two are expressions over f0, the specular colour's channel, and n, the
// shininess: see modelBounds() in host/scene/models.hpp. A material may choose one; the others have that of
// the picture's settings. G-buffer files have these numbers: new rows go to the end.
#ifndef LUCIOLE_MODELS_H
#define LUCIOLE_MODELS_H

#define EACH_MODEL(X)                                                                                       \
  X(Phong, "phong", "Phong", "the model with highlights of (R.V)^n", 1, f0)                                 \
  X(BlinnPhong, "blinn-phong", "Blinn-Phong", "the model with highlights of (N.H)^n", 1, f0)                \
  X(Toon, "toon", "toon", "the model that lights in flat steps", 1, f0)                                     \
  X(CookTorrance, "cook-torrance", "Cook-Torrance", "the model of rough surfaces, D G F / (4 N.L N.V)", 1,  \
    mostCookTorrance(f0, n))                                                                                \
  X(OrenNayar, "oren-nayar", "Oren-Nayar", "the model of rough matte surfaces, with Phong's highlights", 1, \
    f0)                                                                                                     \
  X(Ward, "ward", "Ward", "the model of rough surfaces, exp(-tan^2 / a^2) h.h / (a^2 (h.N)^4)", 1,          \
    mostWard(f0, n))

#endif

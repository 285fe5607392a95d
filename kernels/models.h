// The table of shading models, shared by host and kernels: X(name in code, as people type it, as --stats shows it, what it does).
// A material may choose one; the others have that of the picture's settings. G-buffer files have these numbers: new rows go to the end.
#ifndef LUCIOLE_MODELS_H
#define LUCIOLE_MODELS_H

#define EACH_MODEL(X)                                                                                        \
  X(Phong, "phong", "Phong", "the model with highlights of (R.V)^n")                                         \
  X(BlinnPhong, "blinn-phong", "Blinn-Phong", "the model with highlights of (N.H)^n")                        \
  X(Toon, "toon", "toon", "the model that lights in flat steps")                                             \
  X(CookTorrance, "cook-torrance", "Cook-Torrance", "the model of rough surfaces, D G F / (4 N.L N.V)")      \
  X(OrenNayar, "oren-nayar", "Oren-Nayar", "the model of rough matte surfaces, with Phong's highlights")

#endif

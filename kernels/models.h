// The table of shading models, shared by host and kernels: X(name in code, as people type it, as --stats shows it, what it does).
// A picture has one model, which the command line chooses: no scene file says which.
#ifndef LUCIOLE_MODELS_H
#define LUCIOLE_MODELS_H

#define EACH_MODEL(X)                                                                                        \
  X(Phong, "phong", "Phong", "the model with highlights of (R.V)^n")                                         \
  X(BlinnPhong, "blinn-phong", "Blinn-Phong", "the model with highlights of (N.H)^n")                        \
  X(Toon, "toon", "toon", "the model that lights in flat steps")                                             \
  X(CookTorrance, "cook-torrance", "Cook-Torrance", "the model of rough surfaces, D G F / (4 N.L N.V)")

#endif

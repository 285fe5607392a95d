// What a checking OpenCL runtime must find.

// Work-items of a group write one place with different values.
__kernel void race(__global float* values) { values[0] = get_global_id(0); }

// The way depends on what nobody has written.
__kernel void uninitialized(__global float* values) {
  if (values[get_global_id(0)] > 1.0f) values[get_global_id(0)] = 2.0f;
}

// Beyond the buffer's 16 values.
__kernel void overrun(__global float* values) { values[get_global_id(0) + 16] = 1.0f; }

// One place of a buffer, inside or not.
__kernel void write_at(__global float* values, int place) { values[place] = 1.0f; }
__kernel void read_at(__global const float* values, __global float* found, int place) {
  *found = values[place];
}

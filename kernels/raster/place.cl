/* Puts the caller's positions of a mesh into the vertex buffer. A position outside of the bounds is put on them; one that is
 * not finite stays so, for skg_project to find. */
__kernel void skg_place(skg_place_args args, __global const float *given, long first, __global const int *taken,
                        __global skg_real *vertices, __global int *outside) {
    const int v = (int)get_global_id(0);
    if (v >= args.vertices) return;
    __global const float *from = given + first + 3 * (long)taken[v];
    __global skg_real *to = vertices + 3 * (long)(args.mesh_vertex + v);
    int moved = 0;
    for (int k = 0; k < 3; k++) {
        const float x = from[k];
        const float at = fmin(fmax(x, args.lowest[k]), args.highest[k]);
        const int finite = 0 * x == 0;
        moved |= finite && at != x;
        to[k] = finite ? at : x;
    }
    if (moved) atomic_min(outside + args.mesh, taken[v]);
}

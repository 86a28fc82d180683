! A cube of water in a parallel beam, from Fortran 2018: its path length at the middle is its edge.
!
!     gfortran $(pkg-config --variable=fortran skiagraph) first_image.f90 $(pkg-config --libs skiagraph) -o first_image_f
program first_image
    use skiagraph
    implicit none

    integer(c_int64_t), parameter :: side = 64
    type(c_ptr) :: context, mesh, water, beam, scene, plan, job
    type(skg_part) :: part
    type(skg_view) :: view
    type(skg_output) :: output
    integer(c_int64_t) :: id
    real(c_float), target :: lengths(side, side)
    real(c_float) :: middle

    call skg_check(skg_context_create(context=context))
    call skg_check(skg_mesh_create_cube(30.0_c_double, mesh))
    call skg_check(skg_material_create_named('water' // c_null_char, water))
    call skg_check(skg_spectrum_create_mono(80.0_c_double, 1.0_c_double, beam))
    call skg_check(skg_scene_create(context, scene))
    call skg_init(part)
    part%mesh = mesh
    part%material = water
    call skg_check(skg_scene_part_add(scene, part, id))
    call skg_init(view)
    view%projection = SKG_PROJECTION_PARALLEL
    view%columns = side
    view%rows = side
    view%source = [0.0_c_double, 0.0_c_double, -500.0_c_double]
    view%centre = [0.0_c_double, 0.0_c_double, 100.0_c_double]
    view%column_step = [1.0_c_double, 0.0_c_double, 0.0_c_double]
    view%row_step = [0.0_c_double, 1.0_c_double, 0.0_c_double]
    call skg_check(skg_plan_create(context, scene, view, beam, plan=plan))
    call skg_init(output)
    output%data = c_loc(lengths)
    output%kind = SKG_OUTPUT_LENGTHS
    output%lengths = SKG_LENGTHS_SURFACE
    output%part = id
    call skg_check(skg_plan_submit(plan, 1_c_int64_t, output_count=1_c_int64_t, outputs=[output], job=job))
    call skg_check(skg_job_wait(job))
    middle = lengths(side / 2, side / 2)
    print '(a, f9.5, a)', 'path length through the middle: ', middle, ' mm'
    call skg_plan_release(plan)
    call skg_scene_release(scene)
    call skg_spectrum_release(beam)
    call skg_material_release(water)
    call skg_mesh_release(mesh)
    call skg_context_release(context)
    if (abs(middle - 30.0) > 1.0e-4) error stop 'that is not the edge of the cube'
end program

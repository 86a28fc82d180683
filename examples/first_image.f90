! A cube of water in a parallel beam, from Fortran 2008 through iso_c_binding: its path length at the middle is its edge.
!
!     gfortran first_image.f90 $(pkg-config --libs skiagraph) -o first_image_f && ./first_image_f
program first_image
    use, intrinsic :: iso_c_binding
    implicit none

    integer(c_int32_t), parameter :: parallel = 1, surface = 1
    integer(c_int64_t), parameter :: side = 64

    ! The structs of <skiagraph/scene.h>, <skiagraph/types.h> and <skiagraph/frame.h>, field by field: their layout is
    ! in lib/bindings/interface.json. skg_X_init_sized takes the size of ours.
    type, bind(c) :: skg_part
        integer(c_int32_t) :: size, priority
        integer(c_int64_t) :: inside
        type(c_ptr) :: mesh, material, label
        real(c_double) :: pose(16)
    end type
    type, bind(c) :: skg_view
        integer(c_int32_t) :: size, projection
        integer(c_int64_t) :: columns, rows
        real(c_double) :: source(3), centre(3), column_step(3), row_step(3)
    end type
    type, bind(c) :: skg_output
        integer(c_int32_t) :: size, type
        type(c_ptr) :: data
        integer(c_int64_t) :: row_stride, channel_stride, frame_stride
    end type

    interface
        integer(c_int32_t) function skg_context_create(config, context) bind(c)
            import :: c_int32_t, c_ptr
            type(c_ptr), value :: config
            type(c_ptr) :: context
        end function
        integer(c_int32_t) function skg_mesh_create_cube(edge, mesh) bind(c)
            import :: c_int32_t, c_double, c_ptr
            real(c_double), value :: edge
            type(c_ptr) :: mesh
        end function
        integer(c_int32_t) function skg_material_create_mu(name, per_cm, material) bind(c)
            import :: c_int32_t, c_double, c_ptr
            type(c_ptr), value :: name
            real(c_double), value :: per_cm
            type(c_ptr) :: material
        end function
        integer(c_int32_t) function skg_spectrum_create_mono(energy_kev, photons, spectrum) bind(c)
            import :: c_int32_t, c_double, c_ptr
            real(c_double), value :: energy_kev, photons
            type(c_ptr) :: spectrum
        end function
        integer(c_int32_t) function skg_scene_create(context, scene) bind(c)
            import :: c_int32_t, c_ptr
            type(c_ptr), value :: context
            type(c_ptr) :: scene
        end function
        integer(c_int32_t) function skg_scene_add(scene, part, id) bind(c)
            import :: c_int32_t, c_int64_t, c_ptr, skg_part
            type(c_ptr), value :: scene
            type(skg_part) :: part
            integer(c_int64_t) :: id
        end function
        subroutine skg_part_init_sized(part, size) bind(c)
            import :: c_int32_t, skg_part
            type(skg_part) :: part
            integer(c_int32_t), value :: size
        end subroutine
        subroutine skg_view_init_sized(view, size) bind(c)
            import :: c_int32_t, skg_view
            type(skg_view) :: view
            integer(c_int32_t), value :: size
        end subroutine
        subroutine skg_output_init_sized(output, size) bind(c)
            import :: c_int32_t, skg_output
            type(skg_output) :: output
            integer(c_int32_t), value :: size
        end subroutine
        integer(c_int32_t) function skg_plan_create(context, scene, view, spectrum, options, plan) bind(c)
            import :: c_int32_t, c_ptr, skg_view
            type(c_ptr), value :: context, scene, spectrum, options
            type(skg_view) :: view
            type(c_ptr) :: plan
        end function
        integer(c_int32_t) function skg_plan_lengths(plan, part, kind, count, frames, output, job) bind(c)
            import :: c_int32_t, c_int64_t, c_ptr, skg_output
            type(c_ptr), value :: plan, frames
            integer(c_int64_t), value :: part, count
            integer(c_int32_t), value :: kind
            type(skg_output) :: output
            type(c_ptr) :: job
        end function
        integer(c_int32_t) function skg_job_wait(job) bind(c)
            import :: c_int32_t, c_ptr
            type(c_ptr) :: job
        end function
        subroutine skg_plan_release(plan) bind(c)
            import :: c_ptr
            type(c_ptr) :: plan
        end subroutine
        subroutine skg_scene_release(scene) bind(c)
            import :: c_ptr
            type(c_ptr) :: scene
        end subroutine
        subroutine skg_spectrum_release(spectrum) bind(c)
            import :: c_ptr
            type(c_ptr) :: spectrum
        end subroutine
        subroutine skg_material_release(material) bind(c)
            import :: c_ptr
            type(c_ptr) :: material
        end subroutine
        subroutine skg_mesh_release(mesh) bind(c)
            import :: c_ptr
            type(c_ptr) :: mesh
        end subroutine
        subroutine skg_context_release(context) bind(c)
            import :: c_ptr
            type(c_ptr) :: context
        end subroutine
        type(c_ptr) function skg_last_error() bind(c)
            import :: c_ptr
        end function
    end interface

    type(c_ptr) :: context, mesh, water, beam, scene, plan, job
    type(skg_part) :: part
    type(skg_view) :: view
    type(skg_output) :: output
    integer(c_int64_t) :: id
    real(c_float), target :: lengths(side, side)
    real(c_float) :: middle

    call check(skg_context_create(c_null_ptr, context))
    call check(skg_mesh_create_cube(30.0_c_double, mesh))
    call check(skg_material_create_mu(c_null_ptr, 0.1837_c_double, water))
    call check(skg_spectrum_create_mono(80.0_c_double, 1.0_c_double, beam))
    call check(skg_scene_create(context, scene))
    call skg_part_init_sized(part, int(c_sizeof(part), c_int32_t))
    part%mesh = mesh
    part%material = water
    call check(skg_scene_add(scene, part, id))
    call skg_view_init_sized(view, int(c_sizeof(view), c_int32_t))
    view%projection = parallel
    view%columns = side
    view%rows = side
    view%source = [0.0_c_double, 0.0_c_double, -500.0_c_double]
    view%centre = [0.0_c_double, 0.0_c_double, 100.0_c_double]
    view%column_step = [1.0_c_double, 0.0_c_double, 0.0_c_double]
    view%row_step = [0.0_c_double, 1.0_c_double, 0.0_c_double]
    call check(skg_plan_create(context, scene, view, beam, c_null_ptr, plan))
    call skg_output_init_sized(output, int(c_sizeof(output), c_int32_t))
    output%data = c_loc(lengths)
    call check(skg_plan_lengths(plan, id, surface, 1_c_int64_t, c_null_ptr, output, job))
    call check(skg_job_wait(job))
    middle = lengths(side / 2, side / 2)
    print '(a, f9.5, a)', 'path length through the middle: ', middle, ' mm'
    call skg_plan_release(plan)
    call skg_scene_release(scene)
    call skg_spectrum_release(beam)
    call skg_material_release(water)
    call skg_mesh_release(mesh)
    call skg_context_release(context)
    if (abs(middle - 30.0) > 1.0e-4) call fail('that is not the edge of the cube')

contains

    subroutine check(status)
        integer(c_int32_t), intent(in) :: status
        character(kind=c_char), pointer :: text(:)
        integer :: i
        if (status == 0) return
        call c_f_pointer(skg_last_error(), text, [512])
        do i = 1, 512
            if (text(i) == c_null_char) exit
            write (*, '(a)', advance='no') text(i)
        end do
        print *
        call fail('skiagraph failed')
    end subroutine

    subroutine fail(text)
        character(len=*), intent(in) :: text
        print '(a)', text
        stop 1
    end subroutine
end program

! A thousand images of a scene file in which one part moves, in ten batches. The next batch is prepared while the device
! computes the last one.
!
!     gfortran $(pkg-config --variable=fortran skiagraph) thousand_images.f90 $(pkg-config --libs skiagraph) -o thousand
!     ./thousand scene.json LABEL
program thousand_images
    use skiagraph
    implicit none

    integer(c_int64_t), parameter :: batch = 100, batches = 10
    type(c_ptr) :: context, setup, scene, beam, plan, job(2)
    type(skg_view) :: view
    type(skg_plan_options) :: options
    type(skg_part) :: part
    type(skg_frame) :: frames(batch)
    type(skg_output) :: output
    integer(c_int64_t), target :: id
    real(c_double), target :: poses(16, batch)
    real(c_float), allocatable, target :: images(:, :, :, :) ! column, row, frame, one of two batches
    real(c_double) :: sums(batch * batches)
    character(len=1024) :: path, label
    integer(c_int64_t) :: b, n, which

    call get_command_argument(1, path)
    call get_command_argument(2, label)
    if (len_trim(label) == 0) error stop 'usage: thousand SCENE LABEL'
    call skg_check(skg_context_create(context=context))
    call skg_check(skg_setup_load(context, trim(path) // c_null_char, 0_c_int64_t, setup=setup))
    call skg_check(skg_setup_scene_get(setup, scene))
    call skg_check(skg_setup_spectrum_get(setup, beam))
    call skg_init(view)
    call skg_check(skg_setup_view_get(setup, view))
    call skg_init(options)
    call skg_check(skg_setup_options_get(setup, options))
    call skg_check(skg_scene_part_find(scene, trim(label) // c_null_char, id))
    call skg_init(part)
    call skg_check(skg_scene_part_get(scene, id, part))
    call skg_check(skg_plan_create(context, scene, view, beam, options, plan))
    allocate (images(view%columns, view%rows, batch, 2))
    job = c_null_ptr
    do b = 0, batches
        which = 1 + mod(b, 2_c_int64_t)
        if (b < batches) then
            do n = 1, batch ! submitting copies frames and poses
                poses(:, n) = part%pose
                poses(4, n) = part%pose(4) + 0.02_c_double * real(b * batch + n, c_double) ! mm along x
                call skg_init(frames(n))
                frames(n)%pose_count = 1
                frames(n)%pose_parts = c_loc(id)
                frames(n)%poses = c_loc(poses(1, n))
            end do
            call skg_init(output)
            output%data = c_loc(images(1, 1, 1, which))
            call skg_check(skg_plan_submit(plan, batch, frames, 1_c_int64_t, [output], job(which)))
        end if
        which = 3 - which
        if (b > 0) then
            call skg_check(skg_job_wait(job(which)))
            do n = 1, batch
                sums((b - 1) * batch + n) = sum(real(images(:, :, n, which), c_double))
            end do
        end if
    end do
    print '(a, es13.6, a, es13.6, a)', 'energy on the detector: ', minval(sums), ' to ', maxval(sums), ' keV'
    call skg_plan_release(plan)
    call skg_setup_release(setup)
    call skg_context_release(context)
    if (minval(sums) <= 0.0 .or. minval(sums) == maxval(sums)) error stop 'the part did not move'
end program

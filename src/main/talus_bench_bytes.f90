! SPDX-License-Identifier: MIT
!> Bytes that one soil step must move, by count: every array that a loop reads or writes counts once
!> for that loop, 8 bytes a real and 4 an integer; gathered neighbours are taken to stay in cache;
!> writes count once, as in STREAM. With n nodes, m1 entries of the first level, m2 of the second
!> and p ends of pairs of the stabilisation:
!>
!>   strain         n (48 + 52) + 20 m1, and 8 n to divide by the area without a second level
!>   second level   n 76 + 8 m2, and 72 n to divide by the area with stabilisation; where intact soil is tied
!>                  192 n for its stretch and weights, 80 n gathered with them and 104 n for their means
!>   stress         n (220 + what the physics adds)
!>   stabilisation  n (180) + 28 p, and 72 n between two levels
!>   adjoint        n 76 + 8 m2, and 32 n with stabilisation, 232 n where intact soil is tied; without a
!>                  second level 72 n to divide by the area where there is no stabilisation
!>   force          n (68 + 80) + 20 m1, and 16 n each with stabilisation and with damping
!>   seepage        n 290 + 88 faces, an explicit sub-step; n 100 + 20 m1 more for oblique fluxes
module talus_bench_bytes
  use talus_kinds, only: dp
  use talus_session, only: session_t
  implicit none
  private
  public :: phase_bytes

  integer, parameter, public :: phase_strain = 1, phase_second = 2, phase_stress = 3, &
    phase_stabilise = 4, phase_adjoint = 5, phase_force = 6, phase_seepage = 7, phases = 7
  character(14), parameter, public :: phase_name(phases) = [character(14) :: 'strain', &
    'second level', 'stress', 'stabilisation', 'adjoint', 'force', 'seepage']

contains

  !> Bytes of each phase in one step.
  pure function phase_bytes(session) result(bytes)
    type(session_t), intent(in) :: session
    real(dp) :: bytes(phases)
    real(dp) :: n, first

    bytes = 0.0_dp
    associate (disc => session%disc)
      n = real(disc%n, dp)
      first = 20.0_dp*real(size(disc%scni%node), dp)
      bytes(phase_strain) = 100.0_dp*n + first
      bytes(phase_force) = 148.0_dp*n + first
      if (session%motion%local > 0.0_dp) bytes(phase_force) = bytes(phase_force) + 16.0_dp*n
      if (disc%two_levels .and. .not. disc%damage_only) then
        bytes(phase_second) = 76.0_dp*n + 8.0_dp*real(size(disc%two_level%cell), dp)
        bytes(phase_adjoint) = bytes(phase_second)
        if (disc%stabilised) then
          bytes(phase_second) = bytes(phase_second) + 72.0_dp*n
          bytes(phase_adjoint) = bytes(phase_adjoint) + 32.0_dp*n
          bytes(phase_stabilise) = 72.0_dp*n
        end if
        if (disc%tied) then
          bytes(phase_second) = bytes(phase_second) + 376.0_dp*n
          bytes(phase_stabilise) = bytes(phase_stabilise) + 16.0_dp*n
          bytes(phase_adjoint) = bytes(phase_adjoint) + 232.0_dp*n
        end if
      else
        bytes(phase_strain) = bytes(phase_strain) + 8.0_dp*n
        if (.not. disc%stabilised) bytes(phase_adjoint) = 72.0_dp*n
      end if
      bytes(phase_stress) = stress_bytes(session)*n
      if (disc%stabilised) then
        bytes(phase_stabilise) = bytes(phase_stabilise) + 180.0_dp*n &
          + 28.0_dp*real(size(disc%stabilise%node), dp)
        bytes(phase_force) = bytes(phase_force) + 16.0_dp*n
      end if
      if (session%ground%wet) then
        bytes(phase_seepage) = 290.0_dp*n + 88.0_dp*real(size(disc%dual%edge_node, 2), dp)
        if (session%seepage%flux%oblique) bytes(phase_seepage) = bytes(phase_seepage) &
          + 100.0_dp*n + first
      end if
    end associate
  end function phase_bytes

  !> Bytes of the stress phase at one node: gradient 32, F 64, stress 64, soil 4, area 8, work of
  !> volume 16 and P 32 always (220 with the soil number), the rest as it exists.
  pure real(dp) function stress_bytes(session) result(bytes)
    type(session_t), intent(in) :: session

    bytes = 220.0_dp
    associate (state => session%state)
      if (allocated(state%history)) bytes = bytes + 16.0_dp*real(size(state%history, 1), dp)
      if (allocated(state%opening)) bytes = bytes + 16.0_dp
      if (allocated(state%strain)) bytes = bytes + 64.0_dp
      if (allocated(state%f_drive)) bytes = bytes + 96.0_dp
      if (allocated(state%stiffness)) bytes = bytes + 24.0_dp
      if (allocated(state%water_work)) bytes = bytes + 16.0_dp
    end associate
    ! Jacobian, suction, saturation, pressure; then the water content and what follows from it.
    if (session%ground%wet) bytes = bytes + 48.0_dp
    if (session%motion%coupled) bytes = bytes + 56.0_dp
  end function stress_bytes
end module talus_bench_bytes

! SPDX-License-Identifier: MIT
!> Nodes and elements from a text file:
!>
!>     # comment, up to the end of the line
!>     nodes 4
!>     0.0 0.0        x y [m], and optionally the number of the node's soil
!>     ...
!>     elements 1
!>     4 1 2 3 4      number of corners (3 or 4), node numbers in order around the element
!>
!> Either way round is accepted and turned counter-clockwise. All errors of a file are reported
!> together, each with the line that it is on and what is allowed.
module talus_mesh_file
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_deck
  use talus_text, only: text_of, text_lower, text_to_real
  use talus_read_file, only: text_without_mark
  use talus_nodes, only: mesh_t, mesh_edges, mesh_find_boundary, mesh_tag_sides, &
    mesh_corner_jacobian
  use talus_mesh_check, only: mesh_check_boundary
  implicit none
  private
  public :: mesh_file_read

  integer, parameter :: errors_listed = 20, line_length = 512, word_length = 64, n_words = 8
  !> Largest count of nodes or elements.
  integer, parameter :: most = 200000000

  !> The file being read and what was found wrong with it.
  type :: reader_t
    character(:), allocatable :: path, errors
    integer :: unit = 0, line = 0, n_error = 0
    logical :: at_end = .false., too_long = .false.
    character(line_length) :: text = ''          !! the line as it stands in the file
    character(word_length) :: word(n_words) = '' !! its words without the comment
    integer :: n_word = 0
    integer, allocatable :: element_line(:)      !! line of each element
  end type reader_t

contains

  !> Read and check a mesh; find and tag its boundary by place.
  subroutine mesh_file_read(mesh, path, status)
    type(mesh_t), intent(out) :: mesh
    character(*), intent(in) :: path !! file to read
    type(status_t), intent(inout) :: status
    type(reader_t) :: reader
    type(status_t) :: found
    integer :: error

    reader%path = path
    reader%errors = ''
    open (newunit=reader%unit, file=path, status='old', action='read', iostat=error)
    if (error /= 0) then
      call status_set(status, status_deck, path//': cannot be opened for reading')
      return
    end if
    call read_nodes(reader, mesh)
    if (reader%n_error == 0) call read_elements(reader, mesh)
    close (reader%unit)
    if (reader%n_error == 0) call check_elements(reader, mesh)
    if (reader%n_error == 0) call mesh_find_boundary(mesh, found)
    if (reader%n_error == 0 .and. .not. status_failed(found)) call mesh_check_boundary(mesh, found)
    if (status_failed(found)) call report(reader, found%message, 'whole file')
    if (reader%n_error > 0) then
      if (reader%n_error > errors_listed) reader%errors = reader%errors//new_line('a')//path// &
        ': and '//text_of(reader%n_error - errors_listed)//' more errors'
      call status_set(status, status_deck, reader%errors(2:))
      return
    end if
    call mesh_tag_sides(mesh)
  end subroutine mesh_file_read

  subroutine read_nodes(reader, mesh)
    type(reader_t), intent(inout) :: reader
    type(mesh_t), intent(inout) :: mesh
    integer :: i, n
    logical :: ok

    call read_header(reader, 'nodes', 3, n)
    if (reader%n_error > 0) return
    allocate (mesh%x(2, n))
    do i = 1, n
      call next_line(reader)
      if (reader%at_end) then
        call report(reader, 'the file ends after '//text_of(i - 1)//' of '//text_of(n)//' nodes')
        return
      end if
      if (i == 1 .and. reader%n_word == 3) allocate (mesh%soil(n))
      if (reader%n_word /= merge(3, 2, allocated(mesh%soil))) then
        call report(reader, 'a node is "x y" on all lines or "x y soil" on all lines')
        if (reader%word(1) == 'elements') return
        cycle
      end if
      call text_to_real(trim(reader%word(1)), mesh%x(1, i), ok)
      if (ok) call text_to_real(trim(reader%word(2)), mesh%x(2, i), ok)
      if (.not. ok) call report(reader, 'x and y must be numbers [m] like 1.5 or 2e-3')
      if (.not. allocated(mesh%soil)) cycle
      call word_integer(reader%word(3), mesh%soil(i), ok)
      if (ok) ok = mesh%soil(i) >= 1
      if (.not. ok) call report(reader, 'the soil must be a whole number, 1 or more, '// &
        'after x and y; nodes are not numbered')
    end do
  end subroutine read_nodes

  subroutine read_elements(reader, mesh)
    type(reader_t), intent(inout) :: reader
    type(mesh_t), intent(inout) :: mesh
    integer :: e, m, first, corners

    call read_header(reader, 'elements', 1, m)
    if (reader%n_error > 0) return
    allocate (mesh%element_offset(m+1), mesh%element_nodes(4*m), reader%element_line(m))
    mesh%element_offset = 1
    do e = 1, m
      call next_line(reader)
      if (reader%at_end) then
        call report(reader, 'the file ends after '//text_of(e - 1)//' of '//text_of(m)//' elements')
        return
      end if
      reader%element_line(e) = reader%line
      first = mesh%element_offset(e)
      call read_corners(reader, size(mesh%x, 2), mesh%element_nodes(first:first+3), corners)
      mesh%element_offset(e+1) = first + corners
    end do
    first = mesh%element_offset(m+1)
    mesh%element_nodes = mesh%element_nodes(:first-1)
    call next_line(reader)
    if (.not. reader%at_end) call report(reader, 'nothing may follow the last element')
  end subroutine read_elements

  !> Node numbers of one element; `corners` is 0 when the line was refused.
  subroutine read_corners(reader, n, nodes, corners)
    type(reader_t), intent(inout) :: reader
    integer, intent(in) :: n         !! number of nodes in the mesh
    integer, intent(out) :: nodes(4)
    integer, intent(out) :: corners
    integer :: i
    logical :: ok

    nodes = 0
    call word_integer(reader%word(1), corners, ok)
    if (ok) ok = corners == 3 .or. corners == 4
    if (ok) ok = reader%n_word == corners + 1
    if (.not. ok) then
      call report(reader, 'an element is "3 i j k" or "4 i j k l"')
      corners = 0
      return
    end if
    do i = 1, corners
      call word_integer(reader%word(i+1), nodes(i), ok)
      if (ok) ok = nodes(i) >= 1 .and. nodes(i) <= n
      if (ok) ok = .not. any(nodes(:i-1) == nodes(i))
      if (ok) cycle
      call report(reader, 'the corners must be different node numbers from 1 to '//text_of(n))
      corners = 0
      return
    end do
  end subroutine read_corners

  !> Turn elements counter-clockwise; refuse bad shapes, nodes without element, and elements that
  !> overlap along an edge.
  subroutine check_elements(reader, mesh)
    type(reader_t), intent(inout) :: reader
    type(mesh_t), intent(inout) :: mesh
    integer, allocatable :: edge_node(:,:), edge_corner(:,:), corner_edge(:)
    type(status_t) :: found
    logical, allocatable :: used(:)
    integer :: e, i, first, last

    allocate (used(size(mesh%x, 2)))
    used = .false.
    do e = 1, size(reader%element_line)
      first = mesh%element_offset(e)
      last = mesh%element_offset(e+1) - 1
      used(mesh%element_nodes(first:last)) = .true.
      if (mesh_corner_jacobian(mesh, e) > least_jacobian(mesh, first, last)) cycle
      mesh%element_nodes(first:last) = mesh%element_nodes(last:first:-1)
      if (mesh_corner_jacobian(mesh, e) > least_jacobian(mesh, first, last)) cycle
      call report(reader, 'this element has no area, a corner of 180 degrees or more, or its '// &
        'corners are not in order around it', 'line '//text_of(reader%element_line(e)))
    end do
    do i = 1, size(used)
      if (.not. used(i)) call report(reader, 'it belongs to no element: remove it', &
        'node '//text_of(i))
    end do
    if (reader%n_error > 0) return
    call mesh_edges(mesh, edge_node, edge_corner, corner_edge, found, e)
    if (status_failed(found)) call report(reader, found%message, &
                                          'line '//text_of(reader%element_line(e)))
  end subroutine check_elements

  !> Corner Jacobian that passes as round-off for an element of this size [m2].
  pure real(dp) function least_jacobian(mesh, first, last) result(least)
    type(mesh_t), intent(in) :: mesh
    integer, intent(in) :: first, last !! the element's corners
    integer :: k

    least = 0.0_dp
    do k = first + 1, last
      least = max(least, 1.0e-6_dp*sum((mesh%x(:, mesh%element_nodes(k)) &
                                        - mesh%x(:, mesh%element_nodes(first)))**2))
    end do
  end function least_jacobian

  !> A line "name count" with a count of at least `least`.
  subroutine read_header(reader, name, least, n)
    type(reader_t), intent(inout) :: reader
    character(*), intent(in) :: name
    integer, intent(in) :: least
    integer, intent(out) :: n
    logical :: ok

    call next_line(reader)
    n = 0
    ok = .not. reader%at_end .and. reader%n_word == 2 .and. text_lower(reader%word(1)) == name
    if (ok) call word_integer(reader%word(2), n, ok)
    if (ok) ok = n >= least .and. n <= most
    if (.not. ok) call report(reader, 'expected "'//name//' N" with N from '//text_of(least)// &
      ' to '//text_of(most))
  end subroutine read_header

  !> Go to the next line with words on it.
  subroutine next_line(reader)
    type(reader_t), intent(inout) :: reader
    integer :: error

    do
      read (reader%unit, '(a)', advance='no', iostat=error) reader%text
      reader%too_long = error == 0
      if (reader%too_long) read (reader%unit, '()', iostat=error)
      reader%at_end = error /= 0 .and. .not. is_iostat_eor(error)
      if (reader%at_end) then
        reader%text = '(end of file)'
        reader%n_word = 0
        return
      end if
      reader%line = reader%line + 1
      if (reader%line == 1) reader%text = text_without_mark(reader%text)
      call split_words(reader)
      if (reader%n_word > 0) return
    end do
  end subroutine next_line

  !> Words of the line before any comment; more than n_words of them, a word or a line that is too
  !> long count as n_words + 1.
  subroutine split_words(reader)
    type(reader_t), intent(inout) :: reader
    logical :: blank, in_word
    integer :: i, length

    reader%n_word = 0
    reader%word = ''
    in_word = .false.
    length = 0
    do i = 1, line_length
      if (reader%text(i:i) == '#') return
      blank = index(' '//achar(9)//achar(13), reader%text(i:i)) > 0
      if (.not. blank .and. .not. in_word) then
        if (reader%n_word > n_words) exit
        reader%n_word = reader%n_word + 1
        length = 0
      end if
      in_word = .not. blank
      length = length + 1
      if (.not. blank .and. length > word_length) reader%n_word = n_words + 1
      if (blank .or. reader%n_word > n_words) cycle
      reader%word(reader%n_word)(length:length) = reader%text(i:i)
    end do
    if (reader%too_long) reader%n_word = n_words + 1
  end subroutine split_words

  pure subroutine word_integer(word, value, ok)
    character(*), intent(in) :: word
    integer, intent(out) :: value
    logical, intent(out) :: ok
    integer :: error

    value = 0
    error = 1
    if (verify(trim(word), '0123456789+-') == 0) read (word, *, iostat=error) value
    ok = error == 0
  end subroutine word_integer

  !> Add an error about the present line, or about the place named.
  subroutine report(reader, message, place)
    type(reader_t), intent(inout) :: reader
    character(*), intent(in) :: message
    character(*), intent(in), optional :: place

    reader%n_error = reader%n_error + 1
    if (reader%n_error > errors_listed) return
    reader%errors = reader%errors//new_line('a')//reader%path//', '
    if (present(place)) then
      reader%errors = reader%errors//place//': '//message
    else
      reader%errors = reader%errors//'line '//text_of(reader%line)//', "'// &
        trim(adjustl(reader%text))//'": '//message
    end if
  end subroutine report
end module talus_mesh_file

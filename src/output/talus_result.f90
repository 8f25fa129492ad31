! SPDX-License-Identifier: MIT
!> The result file of a run (HDF5, schema in post/README.md) and its XDMF description.
!> The file is open only while something is written, and a snapshot gets its name only when all of
!> it is on disk, so that a killed run leaves the snapshots finished so far.
module talus_result
  use talus_kinds, only: dp
  use talus_status, only: status_t, status_set, status_failed, status_io
  use talus_text, only: text_of
  use talus_file, only: file_exists, file_delete
  use talus_h5, only: h5_file_t, h5_create, h5_open, h5_close, h5_group_begin, h5_group_end, &
    h5_group_roomy, h5_write, h5_attribute
  use talus_xdmf, only: xdmf_t, xdmf_create, xdmf_begin, xdmf_field, xdmf_write
  implicit none
  private
  public :: result_create, result_write_text, result_write_attribute, result_write_mesh
  public :: snapshot_begin, snapshot_begin_named, snapshot_field, snapshot_end

  !> Version of the layout of the file.
  integer, parameter :: schema_version = 1

  !> A result file being written.
  type, public :: result_t
    character(:), allocatable :: path      !! of the HDF5 file
    character(:), allocatable :: xdmf_path !! of the XDMF file, empty when none is wanted
    integer :: snapshots = 0               !! finished and numbered
    type(h5_file_t), private :: file       !! open during a snapshot
    type(xdmf_t), private :: xdmf
    character(:), allocatable, private :: group !! of the current snapshot
    integer, private :: nodes = 0
  end type result_t

  !> Write an attribute of the file: text, real or integer.
  interface result_write_attribute
    module procedure write_attribute_text, write_attribute_real, write_attribute_integer
  end interface result_write_attribute

  !> Write a nodal field of the current snapshot: (n), or (ncomp, n).
  interface snapshot_field
    module procedure field_scalar, field_vector
  end interface snapshot_field

contains

  !> Create the file; one that exists is refused unless it may be overwritten.
  subroutine result_create(result, path, snapshots, overwrite, xdmf, status)
    type(result_t), intent(out) :: result
    character(*), intent(in) :: path   !! of the HDF5 file, ending in .h5
    integer, intent(in) :: snapshots   !! how many are expected; more can be written
    logical, intent(in) :: overwrite   !! an existing file may be replaced
    logical, intent(in) :: xdmf        !! also write a description for ParaView beside it
    type(status_t), intent(inout) :: status
    integer :: dot

    result%path = path
    result%xdmf_path = ''
    result%group = ''
    dot = index(path, '.', back=.true.)
    if (dot <= index(path, '/', back=.true.) + 1) dot = len(path) + 1
    if (xdmf) result%xdmf_path = path(:dot-1)//'.xdmf'
    if (status_failed(status)) return
    if (file_exists(path) .and. .not. overwrite) then
      call status_set(status, status_io, 'result file '''//path//''': exists already; give '// &
        '--overwrite to replace it, or another output folder')
      return
    end if
    if (len(result%xdmf_path) > 0) call file_delete(result%xdmf_path)
    call h5_create(result%file, path, status)
    call h5_attribute(result%file, '/', 'schema_version', schema_version, status)
    call h5_group_roomy(result%file, '/snapshots', snapshots, status)
    call h5_group_roomy(result%file, '/restart', snapshots, status)
    call h5_close(result%file, status)
  end subroutine result_create

  !> Write one text, e.g. '/deck/text'.
  subroutine result_write_text(result, name, text, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name !! path of the dataset
    character(*), intent(in) :: text
    type(status_t), intent(inout) :: status

    call h5_open(result%file, result%path, status)
    call h5_write(result%file, name, text, status)
    call h5_close(result%file, status)
  end subroutine result_write_text

  subroutine write_attribute_text(result, name, value, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name, value
    type(status_t), intent(inout) :: status

    call h5_open(result%file, result%path, status)
    call h5_attribute(result%file, '/', name, value, status)
    call h5_close(result%file, status)
  end subroutine write_attribute_text

  subroutine write_attribute_real(result, name, value, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name
    real(dp), intent(in) :: value
    type(status_t), intent(inout) :: status

    call h5_open(result%file, result%path, status)
    call h5_attribute(result%file, '/', name, value, status)
    call h5_close(result%file, status)
  end subroutine write_attribute_real

  subroutine write_attribute_integer(result, name, value, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name
    integer, intent(in) :: value
    type(status_t), intent(inout) :: status

    call h5_open(result%file, result%path, status)
    call h5_attribute(result%file, '/', name, value, status)
    call h5_close(result%file, status)
  end subroutine write_attribute_integer

  !> Write nodes, soils, cells and the elements that the cells were built from.
  subroutine result_write_mesh(result, nodes, soil, soil_names, cell_area, element_offset, &
    element_nodes, status)
    type(result_t), intent(inout) :: result
    real(dp), intent(in), contiguous :: nodes(:,:) !! reference positions [m], (2,n)
    integer, intent(in), contiguous :: soil(:) !! soil of each node, from 1, (n)
    character(*), intent(in) :: soil_names(:)
    real(dp), intent(in), contiguous :: cell_area(:) !! reference area of each nodal cell [m2], (n)
    integer, intent(in) :: element_offset(:)  !! first entry of each element, from 1, (ne+1)
    integer, intent(in) :: element_nodes(:)   !! corners, from 1 (0 in the file), 3 or 4 each
    type(status_t), intent(inout) :: status
    integer, allocatable :: topology(:)
    integer :: ne

    if (status_failed(status)) return
    ne = size(element_offset) - 1
    result%nodes = size(nodes, 2)
    allocate (topology(size(element_nodes) + ne))
    call fill_topology(element_offset, element_nodes, topology)
    call h5_open(result%file, result%path, status)
    associate (file => result%file)
      call h5_write(file, '/mesh/nodes', nodes, status)
      call describe(file, '/mesh/nodes', 'm', 'reference positions x, y', status)
      call h5_write(file, '/mesh/soil', soil, status)
      call describe(file, '/mesh/soil', '1', 'index into soil_names, from 1', status)
      call h5_write(file, '/mesh/soil_names', soil_names, status)
      call h5_write(file, '/mesh/cell_area', cell_area, status)
      call describe(file, '/mesh/cell_area', 'm2', 'reference area of the nodal cell', status)
      call h5_write(file, '/mesh/element_offset', element_offset - 1, status)
      call describe(file, '/mesh/element_offset', '1', &
        'element e, from 0, has the corners element_nodes[offset[e]:offset[e+1]]', status)
      call h5_write(file, '/mesh/element_nodes', element_nodes - 1, status)
      call describe(file, '/mesh/element_nodes', '1', 'corners, nodes counted from 0', status)
      call h5_write(file, '/mesh/xdmf_topology', topology, status)
      call describe(file, '/mesh/xdmf_topology', '1', 'elements as XDMF reads them', status)
      call h5_write(file, '/mesh/zero', spread(0.0_dp, 1, size(nodes, 2)), status)
      call describe(file, '/mesh/zero', '1', 'third component of vectors for XDMF', status)
    end associate
    call h5_close(result%file, status)
    call xdmf_create(result%xdmf, result%xdmf_path, result%path, result%nodes, ne, size(topology))
  end subroutine result_write_mesh

  !> Element types and corners as XDMF's mixed topology wants them: 4 triangle, 5 quadrilateral.
  pure subroutine fill_topology(element_offset, element_nodes, topology)
    integer, intent(in) :: element_offset(:) !! first entry of each element, from 1, (ne+1)
    integer, intent(in) :: element_nodes(:)  !! corners, from 1
    integer, intent(out) :: topology(:)      !! (size(element_nodes) + ne)
    integer :: e, first, last, at

    at = 0
    do e = 1, size(element_offset) - 1
      first = element_offset(e)
      last = element_offset(e+1) - 1
      topology(at+1) = last - first + 2
      topology(at+2:at+2+last-first) = element_nodes(first:last) - 1
      at = at + last - first + 2
    end do
  end subroutine fill_topology

  !> Say what a dataset holds.
  subroutine describe(file, name, units, description, status)
    type(h5_file_t), intent(in) :: file
    character(*), intent(in) :: name, units, description
    type(status_t), intent(inout) :: status

    call h5_attribute(file, name, 'units', units, status)
    call h5_attribute(file, name, 'description', description, status)
  end subroutine describe

  !> Start the next numbered snapshot: /snapshots/000000 and so on.
  subroutine snapshot_begin(result, time, stage, step, status)
    type(result_t), intent(inout) :: result
    real(dp), intent(in) :: time       !! simulated time [s]
    character(*), intent(in) :: stage  !! name of the stage
    integer, intent(in) :: step        !! number of soil steps so far
    type(status_t), intent(inout) :: status
    character(6) :: number

    write (number, '(i6.6)') result%snapshots
    call snapshot_begin_named(result, number, time, stage, step, status)
    if (.not. status_failed(status)) result%snapshots = result%snapshots + 1
  end subroutine snapshot_begin

  !> Start a snapshot with a name, such as last_good.
  subroutine snapshot_begin_named(result, name, time, stage, step, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name   !! of the group in /snapshots
    real(dp), intent(in) :: time       !! simulated time [s]
    character(*), intent(in) :: stage  !! name of the stage
    integer, intent(in) :: step        !! number of soil steps so far
    type(status_t), intent(inout) :: status

    if (status_failed(status)) return
    result%group = '/snapshots/'//name
    call h5_open(result%file, result%path, status)
    call h5_group_begin(result%file, status)
    call h5_attribute(result%file, '.', 'time', time, status)
    call h5_attribute(result%file, '.', 'stage', stage, status)
    call h5_attribute(result%file, '.', 'step', step, status)
    if (len(result%xdmf_path) > 0) call xdmf_begin(result%xdmf, result%group, time)
  end subroutine snapshot_begin_named

  subroutine field_scalar(result, name, units, description, data, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name         !! of the dataset, e.g. pore_pressure
    character(*), intent(in) :: units        !! e.g. Pa, 1 for none
    character(*), intent(in) :: description  !! with sign convention
    real(dp), intent(in), contiguous :: data(:) !! (n)
    type(status_t), intent(inout) :: status

    if (status_failed(status)) return
    call h5_write(result%file, name, data, status)
    call field_finish(result, name, units, description, 1, size(data), status)
  end subroutine field_scalar

  subroutine field_vector(result, name, units, description, data, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name         !! of the dataset, e.g. displacement
    character(*), intent(in) :: units        !! e.g. m, 1 for none
    character(*), intent(in) :: description  !! with sign convention and components
    real(dp), intent(in), contiguous :: data(:,:) !! (ncomp,n)
    type(status_t), intent(inout) :: status

    if (status_failed(status)) return
    call h5_write(result%file, name, data, status)
    call field_finish(result, name, units, description, size(data, 1), size(data, 2), status)
  end subroutine field_vector

  !> Attributes of a field, and its line in the XDMF file.
  subroutine field_finish(result, name, units, description, components, n, status)
    type(result_t), intent(inout) :: result
    character(*), intent(in) :: name, units, description
    integer, intent(in) :: components, n !! numbers per node, number of nodes
    type(status_t), intent(inout) :: status

    if (n /= result%nodes) call status_set(status, status_io, 'result file '''//result%path// &
      ''', field '''//name//''': has '//text_of(n)//' nodes, the mesh has '//text_of(result%nodes))
    call describe(result%file, name, units, description, status)
    if (len(result%xdmf_path) > 0) call xdmf_field(result%xdmf, name, components)
  end subroutine field_finish

  !> Give the snapshot its name, close the file, and list the snapshot in the XDMF file.
  subroutine snapshot_end(result, status)
    type(result_t), intent(inout) :: result
    type(status_t), intent(inout) :: status

    call h5_group_end(result%file, result%group, status)
    call h5_close(result%file, status)
    if (len(result%xdmf_path) > 0 .and. .not. status_failed(status)) &
      call xdmf_write(result%xdmf, status)
  end subroutine snapshot_end
end module talus_result

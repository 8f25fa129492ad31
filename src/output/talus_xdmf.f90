! SPDX-License-Identifier: MIT
!> XDMF (version 3) description of a result file, for ParaView and VisIt: a temporal collection of
!> grids whose heavy data stay in the HDF5 file. Vectors get a zero third component, which the
!> viewers' filters ask for; a tensor becomes one scalar a component.
module talus_xdmf
  use talus_kinds, only: dp
  use talus_status, only: status_t
  use talus_text, only: text_of
  use talus_file, only: file_replace, file_base_name
  implicit none
  private
  public :: xdmf_create, xdmf_begin, xdmf_field, xdmf_write

  character(*), parameter :: nl = new_line('a')
  character(2), parameter :: tensor_part(4) = ['xx', 'yy', 'zz', 'xy']

  !> What the XDMF file says so far.
  type, public :: xdmf_t
    private
    character(:), allocatable :: path  !! of the XDMF file
    character(:), allocatable :: heavy !! name of the HDF5 file, which lies in the same folder
    character(:), allocatable :: mesh  !! topology and geometry
    character(:), allocatable :: grids !! finished snapshots
    character(:), allocatable :: grid  !! the snapshot being described
    character(:), allocatable :: group !! its group in the HDF5 file
    real(dp) :: time = 0.0_dp          !! its time [s]
    real(dp) :: last = -huge(1.0_dp)   !! time of the latest finished one [s]
    integer :: nodes = 0               !! number of nodes
  end type xdmf_t

contains

  !> Describe the mesh.
  subroutine xdmf_create(xdmf, path, heavy_path, nodes, elements, topology)
    type(xdmf_t), intent(out) :: xdmf
    character(*), intent(in) :: path       !! of the XDMF file to write
    character(*), intent(in) :: heavy_path !! of the HDF5 file
    integer, intent(in) :: nodes           !! number of nodes
    integer, intent(in) :: elements        !! number of triangles and quadrilaterals
    integer, intent(in) :: topology        !! length of /mesh/xdmf_topology

    xdmf%path = path
    xdmf%heavy = escaped(file_base_name(heavy_path))
    xdmf%nodes = nodes
    xdmf%grids = ''
    xdmf%grid = ''
    xdmf%group = ''
    xdmf%mesh = '      <Topology TopologyType="Mixed" NumberOfElements="'//text_of(elements)// &
      '">'//nl//'        <DataItem Dimensions="'//text_of(topology)// &
      '" NumberType="Int" Precision="4" Format="HDF">'//xdmf%heavy// &
      ':/mesh/xdmf_topology</DataItem>'//nl//'      </Topology>'//nl// &
      '      <Geometry GeometryType="XY">'//nl//heavy_item(xdmf, '/mesh/nodes', 2)// &
      '      </Geometry>'//nl
  end subroutine xdmf_create

  !> Start the description of a snapshot.
  subroutine xdmf_begin(xdmf, group, time)
    type(xdmf_t), intent(inout) :: xdmf
    character(*), intent(in) :: group !! of the snapshot in the HDF5 file, '/snapshots/000000'
    real(dp), intent(in) :: time      !! [s]

    xdmf%group = group
    xdmf%time = time
    xdmf%grid = '    <Grid Name="'//escaped(group)//'">'//nl//'      <Time Value="'// &
      text_of(time, 15)//'"/>'//nl//xdmf%mesh
  end subroutine xdmf_begin

  !> Describe one field of the snapshot. Fields with another number of components than 1 (scalar),
  !> 2 (vector) and 4 (tensor) are left out.
  subroutine xdmf_field(xdmf, name, components)
    type(xdmf_t), intent(inout) :: xdmf
    character(*), intent(in) :: name  !! of the dataset in the snapshot's group
    integer, intent(in) :: components !! numbers per node
    character(:), allocatable :: source, n
    integer :: i

    source = xdmf%group//'/'//name
    n = text_of(xdmf%nodes)
    select case (components)
    case (1)
      call attribute_add(xdmf, name, 'Scalar', heavy_item(xdmf, source, 1))
    case (2)
      call attribute_add(xdmf, name, 'Vector', &
        '        <DataItem ItemType="Function" Function="JOIN($0, $1, $2)" Dimensions="'//n// &
        ' 3">'//nl//slab(xdmf, source, 2, 1)//slab(xdmf, source, 2, 2)// &
        heavy_item(xdmf, '/mesh/zero', 1)//'        </DataItem>'//nl)
    case (4)
      do i = 1, 4
        call attribute_add(xdmf, name//'_'//tensor_part(i), 'Scalar', slab(xdmf, source, 4, i))
      end do
    end select
  end subroutine xdmf_field

  !> Finish the snapshot, if one was begun, and write the whole file anew. Viewers show one grid for
  !> each time: the end of a stage stands for the start of the next, which has the same soil.
  subroutine xdmf_write(xdmf, status)
    type(xdmf_t), intent(inout) :: xdmf
    type(status_t), intent(inout) :: status

    if (len(xdmf%grid) > 0 .and. xdmf%time > xdmf%last) then
      xdmf%grids = xdmf%grids//xdmf%grid//'    </Grid>'//nl
      xdmf%last = xdmf%time
    end if
    xdmf%grid = ''
    call file_replace(xdmf%path, '<?xml version="1.0" encoding="utf-8"?>'//nl// &
      '<Xdmf Version="3.0">'//nl//' <Domain>'//nl// &
      '  <Grid Name="snapshots" GridType="Collection" CollectionType="Temporal">'//nl// &
      xdmf%grids//'  </Grid>'//nl//' </Domain>'//nl//'</Xdmf>'//nl, status)
  end subroutine xdmf_write

  subroutine attribute_add(xdmf, name, kind_of, item)
    type(xdmf_t), intent(inout) :: xdmf
    character(*), intent(in) :: name, kind_of !! Scalar or Vector
    character(*), intent(in) :: item          !! its DataItem

    xdmf%grid = xdmf%grid//'      <Attribute Name="'//escaped(name)//'" AttributeType="'// &
      kind_of//'" Center="Node">'//nl//item//'      </Attribute>'//nl
  end subroutine attribute_add

  !> A dataset of the HDF5 file with `components` numbers per node.
  pure function heavy_item(xdmf, source, components) result(item)
    type(xdmf_t), intent(in) :: xdmf
    character(*), intent(in) :: source !! path of the dataset
    integer, intent(in) :: components
    character(:), allocatable :: item

    item = '        <DataItem Dimensions="'//text_of(xdmf%nodes)//' '//text_of(components)// &
      '" NumberType="Float" Precision="8" Format="HDF">'//xdmf%heavy//':'//escaped(source)// &
      '</DataItem>'//nl
  end function heavy_item

  !> One component of a dataset.
  pure function slab(xdmf, source, components, part) result(item)
    type(xdmf_t), intent(in) :: xdmf
    character(*), intent(in) :: source !! path of the dataset
    integer, intent(in) :: components  !! numbers per node in the dataset
    integer, intent(in) :: part        !! the one wanted, from 1
    character(:), allocatable :: item

    item = '        <DataItem ItemType="HyperSlab" Dimensions="'//text_of(xdmf%nodes)//' 1">'// &
      nl//'        <DataItem Dimensions="3 2" Format="XML">0 '//text_of(part-1)//' 1 1 '// &
      text_of(xdmf%nodes)//' 1</DataItem>'//nl//heavy_item(xdmf, source, components)// &
      '        </DataItem>'//nl
  end function slab

  !> Text with the letters XML reserves replaced.
  pure function escaped(text) result(safe)
    character(*), intent(in) :: text
    character(:), allocatable :: safe
    integer :: i

    safe = ''
    do i = 1, len(text)
      select case (text(i:i))
      case ('&')
        safe = safe//'&amp;'
      case ('<')
        safe = safe//'&lt;'
      case ('>')
        safe = safe//'&gt;'
      case ('"')
        safe = safe//'&quot;'
      case default
        safe = safe//text(i:i)
      end select
    end do
  end function escaped
end module talus_xdmf

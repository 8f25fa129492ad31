! SPDX-License-Identifier: MIT
!> Namelist text cut into tokens, each with its line.
module talus_deck_token
  use talus_deck_messages, only: messages_t, messages_error
  implicit none
  private
  public :: token_t, tokens_of

  !> Kinds of token.
  integer, parameter, public :: token_word = 1, token_quoted = 2, token_equals = 3
  integer, parameter, public :: token_comma = 4, token_slash = 5, token_group = 6, token_end = 7

  type :: token_t
    integer :: kind = token_end
    integer :: line = 0
    character(:), allocatable :: text   !! word, content of a quoted text, or name of a group
  end type token_t

  character, parameter :: newline = achar(10)

contains

  !> All tokens of a deck, closed by a token_end.
  subroutine tokens_of(text, tokens, messages)
    character(*), intent(in) :: text
    type(token_t), allocatable, intent(out) :: tokens(:)
    type(messages_t), intent(inout) :: messages
    integer :: at, line, n

    allocate (tokens(64))
    at = 1
    line = 1
    n = 0
    do
      call skip_blank(text, at, line)
      if (n == size(tokens)) call grow(tokens)
      n = n + 1
      call next_token(text, at, line, tokens(n), messages)
      if (tokens(n)%kind == token_end) exit
    end do
    tokens = tokens(:n)
  end subroutine tokens_of

  subroutine grow(tokens)
    type(token_t), allocatable, intent(inout) :: tokens(:)
    type(token_t), allocatable :: larger(:)

    allocate (larger(2*size(tokens)))
    larger(:size(tokens)) = tokens
    call move_alloc(larger, tokens)
  end subroutine grow

  !> Move past spaces, line ends and comments.
  subroutine skip_blank(text, at, line)
    character(*), intent(in) :: text
    integer, intent(inout) :: at, line
    logical :: in_comment

    in_comment = .false.
    do while (at <= len(text))
      if (text(at:at) == newline) then
        line = line + 1
        in_comment = .false.
      else if (text(at:at) == '!') then
        in_comment = .true.
      else if (.not. in_comment .and. .not. is_space(text(at:at))) then
        return
      end if
      at = at + 1
    end do
  end subroutine skip_blank

  !> Space, tab, carriage return or form feed.
  pure logical function is_space(letter)
    character, intent(in) :: letter

    is_space = letter == ' ' .or. letter == achar(9) .or. letter == achar(13) &
               .or. letter == achar(12)
  end function is_space

  !> Read the token that starts at `at`.
  subroutine next_token(text, at, line, token, messages)
    character(*), intent(in) :: text
    integer, intent(inout) :: at
    integer, intent(in) :: line
    type(token_t), intent(out) :: token
    type(messages_t), intent(inout) :: messages

    token%line = line
    token%text = ''
    if (at > len(text)) return
    select case (text(at:at))
    case ('=')
      token%kind = token_equals
    case (',')
      token%kind = token_comma
    case ('/')
      token%kind = token_slash
    case ('''', '"')
      token%kind = token_quoted
      call read_quoted(text, at, line, token%text, messages)
      return
    case ('&')
      token%kind = token_group
      at = at + 1
      call read_word(text, at, token%text)
      return
    case default
      token%kind = token_word
      call read_word(text, at, token%text)
      return
    end select
    token%text = text(at:at)
    at = at + 1
  end subroutine next_token

  !> Text in quotes; a doubled quote stands for one. It may not run over the end of its line.
  subroutine read_quoted(text, at, line, content, messages)
    character(*), intent(in) :: text
    integer, intent(inout) :: at
    integer, intent(in) :: line
    character(:), allocatable, intent(out) :: content
    type(messages_t), intent(inout) :: messages
    character :: quote

    quote = text(at:at)
    content = ''
    at = at + 1
    do while (at <= len(text))
      if (text(at:at) == newline) exit
      if (text(at:at) == quote) then
        at = at + 1
        if (at > len(text)) return
        if (text(at:at) /= quote) return
      end if
      content = content//text(at:at)
      at = at + 1
    end do
    call messages_error(messages, line, 'text '//quote//trim(content)// &
        ' has no closing quote on its &
                        &line; allowed: '//quote//'...'//quote)
  end subroutine read_quoted

  !> Letters up to a space or separator; what stands in parentheses belongs to the word.
  subroutine read_word(text, at, word)
    character(*), intent(in) :: text
    integer, intent(inout) :: at
    character(:), allocatable, intent(out) :: word
    integer :: start, depth

    start = at
    depth = 0
    do while (at <= len(text))
      if (is_space(text(at:at)) .or. text(at:at) == newline) exit
      if (depth == 0 .and. index('=,/!&''"', text(at:at)) > 0) exit
      if (text(at:at) == '(') depth = depth + 1
      if (text(at:at) == ')') depth = max(0, depth - 1)
      at = at + 1
    end do
    word = text(start:at-1)
  end subroutine read_word
end module talus_deck_token
